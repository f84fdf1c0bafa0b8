# SPDX-License-Identifier: GPL-3.0-or-later
"""The half of bench_real.py and bench_rival.py inside Blender: a picture of the open file by
Cycles, pictures as the file's view transform shows them, or one of the night scenes as a file.

blender -b --factory-startup FILE --python THIS -- cycles JOB.json
blender -b --factory-startup FILE --python THIS -- show JOB.json
blender -b --factory-startup --python THIS -- night NAME OUT.blend

JOB: `camera`, `size`, `out` (PNG), `samples`, `bounces` (of diffuse light), `transparent`; of show
`pictures` (a PNG for each EXR).
"""

import json
import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from bench.peers.gray_with_alpha import is_gray_with_alpha  # noqa: E402
from bench.scenes import night_scenes  # noqa: E402


def mend_gray_with_alpha() -> None:
    """Cycles of Blender 3.4 divides PNGs of gray and alpha by their alpha, unless they are packed:
    a stream of an alpha of 0.06 then shines like a lamp."""
    for image in bpy.data.images:
        path = Path(bpy.path.abspath(image.filepath, library=image.library))
        if image.source == "FILE" and image.packed_file is None and is_gray_with_alpha(path):
            image.pack()


def cycles(job: dict) -> None:
    mend_gray_with_alpha()
    scene = bpy.context.scene
    if job["camera"]:
        scene.camera = scene.objects[job["camera"]]
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = job["samples"]
    scene.cycles.seed = 0
    scene.cycles.use_denoising = False
    scene.cycles.use_adaptive_sampling = False
    scene.cycles.diffuse_bounces = job["bounces"]
    scene.render.film_transparent = job["transparent"]
    scene.render.resolution_x, scene.render.resolution_y = job["size"]
    scene.render.resolution_percentage = 100
    scene.render.filepath = job["out"]
    image = scene.render.image_settings
    image.file_format, image.color_mode, image.color_depth = "PNG", "RGBA", "8"
    bpy.ops.render.render(write_still=True)


def show(pictures: dict[str, str]) -> None:
    scene = bpy.context.scene
    format_ = scene.render.image_settings
    format_.file_format, format_.color_mode, format_.color_depth = "PNG", "RGBA", "8"
    for exr, png in pictures.items():
        bpy.data.images.load(exr).save_render(png, scene=scene)


def main() -> None:
    verb, *words = sys.argv[sys.argv.index("--") + 1 :]
    if verb == "cycles":
        cycles(json.loads(Path(words[0]).read_text("utf-8")))
    elif verb == "show":
        show(json.loads(Path(words[0]).read_text("utf-8"))["pictures"])
    else:
        name, out = words
        night_scenes.SCENES[name]()
        bpy.ops.wm.save_as_mainfile(filepath=out)


main()
