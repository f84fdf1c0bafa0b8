# SPDX-License-Identifier: GPL-3.0-or-later
"""Sky textures as Blender draws them: by a second Blender, which takes half a second, once for each
sky. What it drew is kept beside the levels."""

import hashlib
import json
import math
import os
import subprocess
import tempfile
from array import array
from pathlib import Path
from typing import Any, NamedTuple

import bpy

from ...core.batch import process_session
from ...core.native import lodestone_native as native
from ...core.session.addon_session import addon_session
from .sky_texture import Color, MeanSky, Sky, SkySun, direction_to_sun, has_sun

FOLDER = "skies"  # in the folder of levels
_SCRIPT = Path(__file__).with_name("sky_in_blender.py")
_LONGEST_S = 60.0  # Taste: a hundred times what it takes
_MOST_KEPT = 32  # Taste: skies in a folder, 100 kB each, or in memory
_VERSION = 1  # of what is kept


class _Pictures(NamedTuple):
    width: int
    height: int
    pixels: array  # [height][width][4], lowest row first
    sun: Color


class DrawnSkies:
    """Those that were drawn; part of the session."""

    def __init__(self) -> None:
        self.pictures: dict[str, _Pictures] = {}  # by what they were drawn from


class DrawnSky(Sky):
    """A sky by its picture."""

    drawn = True

    def __init__(self, pictures: _Pictures, sun: SkySun | None) -> None:
        self._pictures, self.sun = pictures, sun

    def color(self, x: float, y: float, z: float) -> Color:
        width, height, pixels, _ = self._pictures
        u = 0.5 - math.atan2(y, x) / (2.0 * math.pi)
        v = 0.5 + math.atan2(z, math.hypot(x, y)) / math.pi
        column = min(width - 1, max(0, int(u * width)))
        row = min(height - 1, max(0, int(v * height)))
        at = 4 * (row * width + column)
        return (pixels[at], pixels[at + 1], pixels[at + 2])


def drawn_sky(node: Any, width: int, height: int, folder: str) -> Sky:
    """The sky of a sky texture node, in a picture of that size; where Blender cannot draw it, its
    mean. `folder`: that of levels, where it is kept if that is there; "": nowhere."""
    values = _values(node)
    told = json.dumps([_VERSION, bpy.app.version_string, width, height, values], sort_keys=True)
    key = hashlib.sha256(told.encode()).hexdigest()[:32]
    drawn = addon_session().part(DrawnSkies).pictures
    if key not in drawn:
        found = _from_folder(Path(folder) / FOLDER, key) if folder else None
        found = found or _draw(
            values, width, height, Path(folder) / FOLDER if folder else None, key
        )
        if found is None:
            return MeanSky(node)
        while len(drawn) >= _MOST_KEPT:
            del drawn[next(iter(drawn))]
        drawn[key] = found
    pictures = drawn[key]
    sun = None
    if has_sun(node) and max(pictures.sun) > 0.0:
        sun = SkySun(direction_to_sun(node), pictures.sun, node.sun_size)
    return DrawnSky(pictures, sun)


def _values(node: Any) -> dict[str, Any]:
    """What the node's own settings are, whatever the version of Blender has."""
    every = bpy.types.ShaderNode.bl_rna.properties
    found = {}
    for setting in node.bl_rna.properties:
        if setting.identifier in every or setting.type == "POINTER" or setting.is_readonly:
            continue
        value = getattr(node, setting.identifier)
        found[setting.identifier] = list(value) if getattr(setting, "is_array", False) else value
    return found


def _draw(
    values: dict[str, Any], width: int, height: int, kept: Path | None, key: str
) -> _Pictures | None:
    with tempfile.TemporaryDirectory(prefix="lodestone-sky-") as work:
        sky, sun = Path(work) / f"{key}.exr", Path(work) / f"{key}.json"
        job = {"node": values, "width": width, "height": height, "sky": str(sky), "sun": str(sun)}
        command = [bpy.app.binary_path, "-b", "--factory-startup", "--python-exit-code", "1"]
        command += ["--python", str(_SCRIPT), "--", json.dumps(job)]
        try:
            subprocess.run(
                command,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                timeout=_LONGEST_S,
                check=True,
                preexec_fn=process_session.death_with_parent(),
            )
        except (OSError, ValueError, subprocess.SubprocessError):
            return None
        found = _from_folder(Path(work), key)
        if found is not None and kept is not None:
            _keep((sky, sun), kept)
        return found


def _from_folder(folder: Path, key: str) -> _Pictures | None:
    """None where there is none, or not a whole one."""
    try:
        sun = json.loads((folder / f"{key}.json").read_text("utf-8"))
        red, green, blue = (float(value) for value in sun)
        image = native.image_read(str(folder / f"{key}.exr"), bottom_up=True)
    except (OSError, ValueError, TypeError, native.LodestoneError):
        return None
    if not all(math.isfinite(value) for value in (red, green, blue)):
        return None
    return _Pictures(image.width, image.height, image.pixels, (red, green, blue))


def _keep(files: tuple[Path, ...], folder: Path) -> None:
    """Copies files into a folder of a folder of levels that is there, and lets the oldest ones go.
    What cannot be kept is drawn again the next time."""
    if not folder.parent.is_dir():
        return
    try:
        folder.mkdir(exist_ok=True)
        for file in files:
            part = folder / f".{os.getpid()}-{file.name}"
            part.write_bytes(file.read_bytes())
            os.replace(part, folder / file.name)
        old = sorted(folder.glob("[0-9a-f]*.*"), key=lambda file: file.stat().st_mtime)
        for file in old[: -2 * _MOST_KEPT]:
            file.unlink(missing_ok=True)
    except OSError:
        pass
