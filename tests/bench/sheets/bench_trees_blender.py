# SPDX-License-Identifier: GPL-3.0-or-later
"""Inside Blender, for bench_trees.py: trees of a track, each level of the artists' as a .glb.

blender -b TRACK.blend --python bench_trees_blender.py -- OUT NAME ...
"""

import sys
from pathlib import Path

import bpy


def main(out: Path, names: list[str]) -> None:
    scene = bpy.data.scenes.new("tree")
    bpy.context.window.scene = scene
    for name in names:
        levels: dict[int, list] = {}
        for thing in bpy.data.collections[f"LOD {name}"].objects:
            levels.setdefault(thing["stk_lod_level"], []).append(thing)
        for number in (min(levels), max(levels)):
            for thing in list(scene.collection.objects):
                scene.collection.objects.unlink(thing)
            for thing in levels[number]:
                scene.collection.objects.link(thing)
            kind = "full" if number == min(levels) else "artists"
            path = out / f"{name.split('/')[-1]}_{kind}.glb"
            bpy.ops.export_scene.gltf(filepath=str(path), use_active_scene=True)


ARGUMENTS = sys.argv[sys.argv.index("--") + 1 :]
main(Path(ARGUMENTS[0]), ARGUMENTS[1:])
