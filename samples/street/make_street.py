# SPDX-License-Identifier: GPL-3.0-or-later
"""Make a 600 m street as a .blend file.

blender -b --factory-startup --python-exit-code 1 --python samples/street/make_street.py --
    --out build/samples/street.blend [--seed 1] [--json FILE]
"""

import argparse
import json
import os
import sys
import time

import addon_utils
import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import cameras  # noqa: E402
import counts  # noqa: E402
from library import Library  # noqa: E402
from street import Street  # noqa: E402


def arguments():
    """Options after the double dash."""
    parser = argparse.ArgumentParser(prog="make_street.py", description=__doc__)
    parser.add_argument("--out", required=True, help=".blend file to write")
    parser.add_argument("--seed", type=int, default=1, help="another number, another street")
    parser.add_argument("--json", help="file for the counts")
    own = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
    return parser.parse_args(own)


def enable_addon():
    """Enable Lodestone when Blender can find it; say so when not."""
    found = any(
        os.path.exists(os.path.join(path, "lodestone", "__init__.py"))
        for path in addon_utils.paths()
    )
    if found and addon_utils.enable("lodestone") and hasattr(bpy.types.Object, "lodestone"):
        return True
    print("street: the Lodestone add-on is not found; the ground is marked by an ID property only")
    return False


def main():
    """Build, count, save."""
    options = arguments()
    start = time.process_time()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    enable_addon()
    scene = bpy.context.scene
    scene.name = "Street"
    street = Street(scene, options.seed)
    staging = Library.child(street.root, "Lights and Cameras")
    footprints = cameras.build(scene, staging)
    result = dict(street.counts)
    result.update(counts.count(bpy.context.evaluated_depsgraph_get()))
    result["materials"] = len(bpy.data.materials)
    result["far_pixel_meters"] = footprints
    out = os.path.abspath(options.out)
    os.makedirs(os.path.dirname(out), exist_ok=True)
    bpy.ops.wm.save_as_mainfile(filepath=out, compress=False)
    result["file_megabytes"] = round(os.path.getsize(out) / 1e6, 1)
    result["cpu_seconds"] = round(time.process_time() - start, 1)
    text = json.dumps(result, indent=1)
    print(text)
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            file.write(text + "\n")


main()
