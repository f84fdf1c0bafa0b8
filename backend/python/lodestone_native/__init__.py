# SPDX-License-Identifier: GPL-3.0-or-later
"""Lodestone's C interface in Python: the same names without `lds_`, errors as exceptions.

No bpy, no numpy, nothing compiled per Python version. Importing loads neither the library nor the
modules here: a name's module is loaded when the name is first used, the library at the first call,
which says in one sentence when it cannot. So a program that names but a constant starts at once.
"""

from importlib import import_module
from typing import Any

# The names of each module; generate_binding.py makes __init__.pyi of it, the types for mypy.
NAMES = {
    "bake": "BakeStep",
    "buffers": "FaceBuffers MeshBuffers StrandBuffers largest_face",
    "cut": "BatchMesh Choice Cut change_placement kind_counts most_demanding release_meshes",
    "enums": (
        "ANY_LEVEL KIND_COUNT AlphaMode Antialias BakeOp Channel Criterion Drawn "
        "Extension Kind LensFilter LensShape LightKind Met OffScreen Projection RayClass "
        "Rays Role Severity SimplifyMode Stage Status"
    ),
    "errors": "LodestoneError",
    "image": (
        "Image image_add_text image_compare image_compare_shown image_difference_color "
        "image_read image_read_part image_size image_write_png keep_pictures"
    ),
    "job": "Job",
    "library": "abi_version library_path rays_check version",
    "live_picture": "DrawnPart LivePicture povray_run_live",
    "measure": "surface_inertia",
    "model": "Model texture",
    "options": (
        "BuildOptions CostModel LooseOptions MeasureOptions SimplifyOptions StructureOptions"
    ),
    "povray": (
        "PovrayOptions povray_empty_bytes povray_export povray_false_color povray_find "
        "povray_run"
    ),
    "projection": "project_uvs",
    "records": "",
    "structs": "Object Texture",
    "view": "Budget Camera Lens Light Modifiers ScreenLens View",
}
_HOMES = {name: module for module, names in NAMES.items() for name in names.split()}


def __getattr__(name: str) -> Any:
    if name in NAMES:
        return import_module("." + name, __name__)
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    found = getattr(import_module("." + _HOMES[name], __name__), name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted({*globals(), *NAMES, *_HOMES})
