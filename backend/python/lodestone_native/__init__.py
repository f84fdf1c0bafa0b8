# SPDX-License-Identifier: GPL-3.0-or-later
"""Lodestone's C interface in Python: the same names without `lds_`, errors as exceptions.

No bpy, no numpy, nothing compiled per Python version. Importing never loads the library; the first
call does, and says in one sentence when it cannot.
"""

from . import records
from .bake import BakeStep
from .buffers import FaceBuffers, MeshBuffers, StrandBuffers, largest_face
from .cut import (
    BatchMesh,
    Choice,
    Cut,
    change_placement,
    kind_counts,
    most_demanding,
    release_meshes,
)
from .enums import (
    ANY_LEVEL,
    KIND_COUNT,
    AlphaMode,
    Antialias,
    BakeOp,
    Channel,
    Criterion,
    Drawn,
    Extension,
    Kind,
    LensFilter,
    LensShape,
    LightKind,
    Met,
    OffScreen,
    Projection,
    RayClass,
    Rays,
    Role,
    Severity,
    SimplifyMode,
    Stage,
    Status,
)
from .errors import LodestoneError
from .image import (
    Image,
    image_add_text,
    image_compare,
    image_compare_shown,
    image_difference_color,
    image_read,
    image_read_part,
    image_size,
    image_write_png,
    keep_pictures,
)
from .job import Job
from .library import abi_version, library_path, rays_check, version
from .live_picture import DrawnPart, LivePicture, povray_run_live
from .measure import surface_inertia
from .model import Model, texture
from .options import (
    BuildOptions,
    CostModel,
    LooseOptions,
    MeasureOptions,
    SimplifyOptions,
    StructureOptions,
)
from .povray import (
    PovrayOptions,
    povray_empty_bytes,
    povray_export,
    povray_false_color,
    povray_find,
    povray_run,
)
from .projection import project_uvs
from .structs import Object, Texture
from .view import Budget, Camera, Lens, Light, Modifiers, ScreenLens, View

__all__ = [
    "ANY_LEVEL",
    "AlphaMode",
    "Antialias",
    "BakeOp",
    "BakeStep",
    "BatchMesh",
    "Budget",
    "BuildOptions",
    "Camera",
    "Channel",
    "Choice",
    "CostModel",
    "Criterion",
    "Cut",
    "Drawn",
    "DrawnPart",
    "Extension",
    "FaceBuffers",
    "Image",
    "Job",
    "KIND_COUNT",
    "Kind",
    "Lens",
    "LensFilter",
    "LensShape",
    "Light",
    "LightKind",
    "LivePicture",
    "LodestoneError",
    "LooseOptions",
    "MeasureOptions",
    "MeshBuffers",
    "Model",
    "Met",
    "OffScreen",
    "Modifiers",
    "Object",
    "PovrayOptions",
    "Projection",
    "RayClass",
    "Rays",
    "Role",
    "ScreenLens",
    "Severity",
    "SimplifyMode",
    "SimplifyOptions",
    "Stage",
    "Status",
    "StructureOptions",
    "StrandBuffers",
    "Texture",
    "View",
    "abi_version",
    "change_placement",
    "image_add_text",
    "image_compare",
    "image_compare_shown",
    "image_difference_color",
    "image_read",
    "image_read_part",
    "image_size",
    "image_write_png",
    "keep_pictures",
    "kind_counts",
    "largest_face",
    "library_path",
    "most_demanding",
    "povray_empty_bytes",
    "povray_export",
    "povray_false_color",
    "povray_find",
    "povray_run",
    "povray_run_live",
    "project_uvs",
    "rays_check",
    "records",
    "release_meshes",
    "surface_inertia",
    "texture",
    "version",
]
