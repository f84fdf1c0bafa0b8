# SPDX-License-Identifier: GPL-3.0-or-later
"""Options of what is done to a model: the library's defaults, with changes by name."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from typing import Any, TypeVar

from . import structs
from .base import Sized
from .handle import Handle
from .library import check, library
from .structs import Object
from .view import View

Options = TypeVar("Options", bound=Sized)


def changed(options: Options, changes: dict[str, Any]) -> Options:
    """The same struct. Throws TypeError for what is none of its fields."""
    names = {field[0] for field in options._fields_}
    for name, value in changes.items():
        if name not in names:
            raise TypeError(f"{type(options).__name__} has no {name}")
        setattr(options, name, value)
    return options


class StructureOptions(structs.StructureOptions):
    def __init__(self, **changes: Any) -> None:
        super().__init__()
        check(library().lds_structure_options_default(self))
        changed(self, changes)


class LooseOptions(structs.LooseOptions):
    def __init__(self, **changes: Any) -> None:
        super().__init__()
        check(library().lds_loose_options_default(self))
        changed(self, changes)


class MeasureOptions(structs.MeasureOptions):
    def __init__(self, **changes: Any) -> None:
        super().__init__()
        check(library().lds_measure_options_default(self))
        changed(self, changes)


class SimplifyOptions(structs.SimplifyOptions):
    def __init__(self, **changes: Any) -> None:
        super().__init__()
        check(library().lds_simplify_options_default(self))
        changed(self, changes)


class CostModel(structs.CostModel):
    """What drawing costs POV-Ray."""

    def __init__(self) -> None:
        super().__init__()
        check(library().lds_cost_model_default(self))


class BuildOptions(structs.BuildOptions):
    """`scope`: a sequence of Objects; only what is reachable from them is built. `poses`: Models of
    the same scene in other frames, to be kept open for as long as the options are used. `view`: a
    View; only what its picture gains most from is built, in `share` of the picture's time."""

    def __init__(
        self,
        scope: Sequence[Object] = (),
        poses: Sequence[Handle] = (),
        view: View | None = None,
        **changes: Any,
    ) -> None:
        super().__init__()
        check(library().lds_build_options_default(self))
        changed(self, changes)
        # ctypes keeps alive with the options what they point to.
        if poses:
            handles = (ctypes.c_void_p * len(poses))(*(pose.handle for pose in poses))
            self.poses = ctypes.cast(handles, ctypes.POINTER(ctypes.c_void_p))
            self.pose_count = len(poses)
        if scope:
            given = (Object * len(scope))(*scope)
            self.scope = ctypes.cast(given, ctypes.POINTER(Object))
            self.scope_count = len(scope)
        if view is not None:
            self.view = ctypes.pointer(view.struct())
