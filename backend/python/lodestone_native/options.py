# SPDX-License-Identifier: GPL-3.0-or-later
"""Options of what is done to a model: the library's defaults, with changes by name."""

import ctypes
from collections.abc import Sequence
from typing import Any

from . import structs
from .handle import Handle
from .library import library
from .structs import Object


def changed(options: Any, changes: dict[str, Any]) -> Any:
    """The same struct. Throws TypeError for what is none of its fields."""
    names = {field[0] for field in options._fields_}
    for name, value in changes.items():
        if name not in names:
            raise TypeError(f"{type(options).__name__} has no {name}")
        setattr(options, name, value)
    return options


class StructureOptions(structs.StructureOptions):
    def __new__(cls, **changes: Any) -> Any:
        return changed(library().lds_structure_options_default(), changes)


class LooseOptions(structs.LooseOptions):
    def __new__(cls, **changes: Any) -> Any:
        return changed(library().lds_loose_options_default(), changes)


class MeasureOptions(structs.MeasureOptions):
    def __new__(cls, **changes: Any) -> Any:
        return changed(library().lds_measure_options_default(), changes)


class SimplifyOptions(structs.SimplifyOptions):
    def __new__(cls, **changes: Any) -> Any:
        return changed(library().lds_simplify_options_default(), changes)


class BuildOptions(structs.BuildOptions):
    """`scope`: a sequence of Objects; only what is reachable from them is built. `poses`: Models of
    the same scene in other frames, to be kept open for as long as the options are used. `view`: a
    View; only what its picture gains most from is built, in `share` of the picture's time."""

    def __new__(
        cls,
        scope: Sequence[Object] = (),
        poses: Sequence[Handle] = (),
        view: Any = None,
        **changes: Any,
    ) -> Any:
        options = changed(library().lds_build_options_default(), changes)
        if poses:
            handles = (ctypes.c_void_p * len(poses))(*(pose.handle for pose in poses))
            options.poses = handles
            options.pose_count = len(poses)
        if scope:
            options.scope = (Object * len(scope))(*scope)  # ctypes keeps it alive with options
            options.scope_count = len(scope)
        if view is not None:
            options.view = ctypes.pointer(view.struct())
        return options
