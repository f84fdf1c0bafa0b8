# SPDX-License-Identifier: GPL-3.0-or-later
"""Lodestone's C interface in Python: the same names without `lds_`, errors as exceptions.

No bpy, no numpy, nothing compiled per Python version. Importing loads neither the library nor the
modules here: a name's module is loaded when the name is first used, the library at the first call,
which says in one sentence when it cannot. So a program that names but a constant starts at once.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from . import records as records
    from .bake import BakeStep as BakeStep
    from .buffers import (
        FaceBuffers as FaceBuffers,
        MeshBuffers as MeshBuffers,
        StrandBuffers as StrandBuffers,
        largest_face as largest_face,
    )
    from .cut import (
        BatchMesh as BatchMesh,
        Choice as Choice,
        Cut as Cut,
        change_placement as change_placement,
        kind_counts as kind_counts,
        most_demanding as most_demanding,
        release_meshes as release_meshes,
    )
    from .enums import (
        ANY_LEVEL as ANY_LEVEL,
        KIND_COUNT as KIND_COUNT,
        AlphaMode as AlphaMode,
        Antialias as Antialias,
        BakeOp as BakeOp,
        Channel as Channel,
        Criterion as Criterion,
        Drawn as Drawn,
        Extension as Extension,
        Kind as Kind,
        LensFilter as LensFilter,
        LensShape as LensShape,
        LightKind as LightKind,
        Met as Met,
        OffScreen as OffScreen,
        Projection as Projection,
        RayClass as RayClass,
        Rays as Rays,
        Role as Role,
        Severity as Severity,
        SimplifyMode as SimplifyMode,
        Stage as Stage,
        Status as Status,
    )
    from .errors import LodestoneError as LodestoneError
    from .image import (
        Image as Image,
        image_add_text as image_add_text,
        image_compare as image_compare,
        image_compare_shown as image_compare_shown,
        image_difference_color as image_difference_color,
        image_read as image_read,
        image_read_part as image_read_part,
        image_size as image_size,
        image_write_png as image_write_png,
        keep_pictures as keep_pictures,
    )
    from .job import Job as Job
    from .library import (
        abi_version as abi_version,
        library_path as library_path,
        rays_check as rays_check,
        version as version,
    )
    from .live_picture import (
        DrawnPart as DrawnPart,
        LivePicture as LivePicture,
        povray_run_live as povray_run_live,
    )
    from .measure import surface_inertia as surface_inertia
    from .model import Model as Model, texture as texture
    from .options import (
        BuildOptions as BuildOptions,
        CostModel as CostModel,
        LooseOptions as LooseOptions,
        MeasureOptions as MeasureOptions,
        SimplifyOptions as SimplifyOptions,
        StructureOptions as StructureOptions,
    )
    from .povray import (
        PovrayOptions as PovrayOptions,
        povray_empty_bytes as povray_empty_bytes,
        povray_export as povray_export,
        povray_false_color as povray_false_color,
        povray_find as povray_find,
        povray_run as povray_run,
    )
    from .projection import project_uvs as project_uvs
    from .structs import Object as Object, Texture as Texture
    from .view import (
        Budget as Budget,
        Camera as Camera,
        Lens as Lens,
        Light as Light,
        Modifiers as Modifiers,
        ScreenLens as ScreenLens,
        View as View,
    )
else:
    # The names of each module, as above
    _NAMES = {
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
            "BuildOptions CostModel LooseOptions MeasureOptions SimplifyOptions " "StructureOptions"
        ),
        "povray": (
            "PovrayOptions povray_empty_bytes povray_export povray_false_color povray_find "
            "povray_run"
        ),
        "projection": "project_uvs",
        "structs": "Object Texture",
        "view": "Budget Camera Lens Light Modifiers ScreenLens View",
    }
    _HOMES = {name: module for module, names in _NAMES.items() for name in names.split()}

    def __getattr__(name: str) -> Any:
        if name == "records":
            return import_module(".records", __name__)
        if name not in _HOMES:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        found = getattr(import_module("." + _HOMES[name], __name__), name)
        globals()[name] = found
        return found

    def __dir__() -> list[str]:
        return sorted({*globals(), *_HOMES, "records"})
