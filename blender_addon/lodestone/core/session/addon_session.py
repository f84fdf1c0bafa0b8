# SPDX-License-Identifier: GPL-3.0-or-later
"""The session: what the running add-on remembers of scenes, viewports and what runs, in one object.

It begins with the add-on and ends when the add-on is disabled. Handlers, operators, panels and
engines reach it by addon_session(). Nothing of it is ever part of a file.
"""

from typing import Any, TypeVar

from ..picture.compare_plan import Comparison
from ..picture.cost_model import CostMemory
from ..store.store_levels import StoreReader
from .changed_shapes import ChangedShapes
from .kept_model import KeptModels
from .last_check import Check
from .last_render import LastRender

Part = TypeVar("Part")


class AddonSession:
    """The memory of the running add-on. Dictionaries are by the name of a scene."""

    def __init__(self) -> None:
        self.changed_shapes = ChangedShapes()
        self.checks: dict[str, Check] = {}  # by Check Scene or by F12, whichever came last
        self.renders: dict[str, LastRender] = {}
        self.comparisons: dict[str, Comparison] = {}
        self.kept_models = KeptModels()
        self.stores = StoreReader()
        self.costs = CostMemory()
        self._parts: dict[type[Any], Any] = {}

    def part(self, kind: type[Part]) -> Part:
        """The memory of a module above core/, in a class of its own: made when first asked for.
        When it is dropped, its close() is called, if it has one."""
        if kind not in self._parts:
            self._parts.setdefault(kind, kind())
        found: Part = self._parts[kind]
        return found

    def drop(self, kind: type[Any]) -> None:
        """Forgets a part; nothing happens when it was never asked for."""
        part = self._parts.pop(kind, None)
        if hasattr(part, "close"):
            part.close()

    def close(self) -> None:
        """Forgets everything."""
        for kind in list(self._parts):
            self.drop(kind)
        self.kept_models.clear()
        self.stores.forget()


_session = AddonSession()


def addon_session() -> AddonSession:
    """The session that runs."""
    return _session


def end_session() -> None:
    """The add-on is disabled: everything is forgotten, and a new session begins empty."""
    global _session
    ended, _session = _session, AddonSession()
    ended.close()
