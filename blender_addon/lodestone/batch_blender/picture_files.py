# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture files of a batch job: as F12 would save them, differences, thumbnails."""

import os
import shutil
from pathlib import Path

import bpy

from ..core import file_names, run_report
from ..core.exit_codes import ExitCode, Failed
from ..core.native import lodestone_native as native
from ..core.picture import compare_plan
from ..core.picture.picture_maker import Settings

THUMBNAIL = 192  # pixels
THUMBNAIL_OF = 64_000_000  # pixels of the largest picture that gets one


def save(scene, exr: Path, out: Path, with_alpha: bool, stamp: dict[str, str]) -> None:
    """The picture as F12 would save it: through the scene's view transform, as a PNG with the
    stamp's text in it. The old one is replaced only when the new one is complete."""
    format_ = scene.render.image_settings
    before = (format_.file_format, format_.color_mode, format_.color_depth)
    temporary = out.with_name(run_report.temporary_name())
    image = bpy.data.images.load(str(exr))
    try:
        if format_.file_format != "PNG":
            format_.file_format = "PNG"
            format_.color_mode, format_.color_depth = "RGBA", "8"
        if with_alpha or scene.render.film_transparent:
            format_.color_mode = "RGBA"
        image.save_render(str(temporary), scene=scene)
        native.image_add_text(str(temporary), stamp)
        os.replace(temporary, out)
    except (OSError, RuntimeError) as error:
        raise Failed(ExitCode.FAILED, f"cannot write {out}: {error}") from error
    finally:
        format_.file_format, format_.color_mode, format_.color_depth = before
        bpy.data.images.remove(image)
        temporary.unlink(missing_ok=True)


def save_compared(scene, made, out: Path, settings: Settings) -> dict[str, str]:
    """The difference as `out`, and the two pictures beside it. Returns the paths of these two."""
    paths = {}
    both = (settings.of_originals(), settings)
    for word, path, how in zip(compare_plan.WORDS, made.paths, both):
        name = file_names.fitting(out.stem, file_names.LONGEST - len(f"_{word}.png"))
        target = out.with_name(f"{name}_{word}.png")
        save(scene, path, target, False, how.stamp())
        paths[f"{word}_picture"] = str(target)
    temporary = out.with_name(run_report.temporary_name())
    try:
        native.image_write_png(str(temporary), made.image)
        native.image_add_text(str(temporary), settings.stamp())
        os.replace(temporary, out)
    except (OSError, native.LodestoneError) as error:
        raise Failed(ExitCode.FAILED, f"cannot write {out}: {error}") from error
    finally:
        temporary.unlink(missing_ok=True)
    return paths


def save_thumbnail(picture: str, target: str) -> None:
    """A small JPEG of a picture. Failing at it is no failure: the picture is there."""
    image = None
    try:
        width, height = native.image_size(picture)
        if width * height > THUMBNAIL_OF:
            return
        image = bpy.data.images.load(picture)
        scale = min(1.0, THUMBNAIL / max(width, height))
        image.scale(max(1, round(width * scale)), max(1, round(height * scale)))
        image.file_format = "JPEG"
        image.filepath_raw = target
        image.save()
    except (OSError, RuntimeError, native.LodestoneError) as error:
        print(f"no thumbnail: {error}")
    finally:
        if image is not None:
            bpy.data.images.remove(image)


def copy_exr(source: Path, target: Path) -> None:
    """POV-Ray's own picture, beside the one that is shown."""
    temporary = target.with_name(run_report.temporary_name(".exr"))
    try:
        shutil.copyfile(source, temporary)
        os.replace(temporary, target)
    except OSError as error:
        temporary.unlink(missing_ok=True)
        raise Failed(ExitCode.FAILED, f"cannot write {target}: {error}") from error
