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
from .sky_texture import (
    Color,
    MeanSky,
    Sky,
    SkySun,
    direction_to_sun,
    has_sun,
    place_all_around,
)

FOLDER = "skies"  # in the folder of levels
_SCRIPT = Path(__file__).with_name("sky_in_blender.py")
_LONGEST_S = 20.0  # Taste: thirty times what it takes; meanwhile nothing can be stopped
_MOST_KEPT = 32  # Taste: skies in a folder, 100 kB each, or in memory
_VERSION = 2  # of what is kept


class _Pictures(NamedTuple):
    width: int
    height: int
    pixels: array  # [height][width][4], lowest row first
    sun: Color
    files: dict[str, bytes]  # by name, as they are kept


class DrawnSkies:
    """Those that were drawn; part of the session."""

    def __init__(self) -> None:
        self.pictures: dict[str, _Pictures] = {}  # by key
        self.failed: set[str] = set()  # keys of those that could not be drawn


class DrawnSky(Sky):
    """A sky by its picture."""

    drawn = True

    def __init__(self, pictures: _Pictures, sun: SkySun | None) -> None:
        self._pictures, self.sun = pictures, sun

    def color(self, x: float, y: float, z: float) -> Color:
        pictures = self._pictures
        u, v = place_all_around(x, y, z)
        column = min(pictures.width - 1, max(0, int(u * pictures.width)))
        row = min(pictures.height - 1, max(0, int(v * pictures.height)))
        at = 4 * (row * pictures.width + column)
        return (pictures.pixels[at], pictures.pixels[at + 1], pictures.pixels[at + 2])


def drawn_sky(node: Any, width: int, height: int, folder: str) -> Sky:
    """The sky of a sky texture node, in a picture of that size; where Blender cannot draw it, its
    mean. `folder`: that of levels, where it is kept if that is there; "": nowhere."""
    values = _values(node)
    told = json.dumps([_VERSION, bpy.app.version_string, width, height, values], sort_keys=True)
    key = hashlib.sha256(told.encode()).hexdigest()[:32]
    skies = addon_session().part(DrawnSkies)
    drawn = skies.pictures
    kept = Path(folder) / FOLDER if folder else None
    if key not in drawn:
        found = _from_folder(kept, key) if kept is not None else None
        if found is None and key not in skies.failed:
            to_sun = direction_to_sun(node) if has_sun(node) else None
            found = _draw({"node": values, "to_sun": to_sun, "width": width, "height": height}, key)
        if found is None:
            skies.failed.add(key)
            return MeanSky(node)
        while len(drawn) >= _MOST_KEPT:
            del drawn[next(iter(drawn))]
        drawn[key] = found
    pictures = drawn[key]
    if kept is not None and kept.parent.is_dir():
        _keep(pictures.files, kept)
    sun = None
    if max(pictures.sun) > 0.0:
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


def _draw(job: dict[str, Any], key: str) -> _Pictures | None:
    """What sky_in_blender.py makes of its JSON, but for the files that it writes."""
    with tempfile.TemporaryDirectory(prefix="lodestone-sky-") as work:
        sky, sun = Path(work) / f"{key}.exr", Path(work) / f"{key}.json"
        job = {**job, "sky": str(sky), "sun": str(sun)}
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
        return _from_folder(Path(work), key)


def _from_folder(folder: Path, key: str) -> _Pictures | None:
    """None where there is none, or not a whole one."""
    names = (f"{key}.json", f"{key}.exr")
    try:
        files = {name: (folder / name).read_bytes() for name in names}
        red, green, blue = (float(value) for value in json.loads(files[names[0]]))
        image = native.image_read(str(folder / names[1]), bottom_up=True)
    except (OSError, ValueError, TypeError, ArithmeticError, native.LodestoneError):
        return None
    if not all(math.isfinite(value) for value in (red, green, blue)):
        return None
    return _Pictures(image.width, image.height, image.pixels, (red, green, blue), files)


def _keep(files: dict[str, bytes], folder: Path) -> None:
    """Writes files into a folder where they are missing, and lets the oldest ones go. What cannot
    be kept is drawn again the next time."""
    missing = {name: data for name, data in files.items() if not _is_there(folder / name, data)}
    if not missing:
        return
    part = folder / f".{os.getpid()}.part"
    try:
        folder.mkdir(exist_ok=True)
        for name, data in missing.items():
            part.write_bytes(data)
            os.replace(part, folder / name)
        old = sorted(folder.glob("[0-9a-f]*.*"), key=lambda file: file.stat().st_mtime)
        for file in old[: -2 * _MOST_KEPT]:
            file.unlink(missing_ok=True)
    except OSError:
        try:
            part.unlink(missing_ok=True)
        except OSError:
            pass


def _is_there(path: Path, data: bytes) -> bool:
    try:
        return path.read_bytes() == data
    except OSError:
        return False
