# SPDX-License-Identifier: GPL-3.0-or-later
"""Inside Blender: reads each .blend and prints how its model differs from the render depsgraph.

    BLENDER_USER_SCRIPTS=<stage> blender -b --factory-startup --python-exit-code 1 \\
        --python tests/end_to_end/print_differences.py -- FILE...

For each file one JSON line {"file", "occurrences", "shown", "differences": [...]}.
"""

import json
import sys

import addon_utils
import bpy

addon_utils.enable("lodestone", default_set=True)

from lodestone.engines import extract_engine  # noqa: E402

for path in sys.argv[sys.argv.index("--") + 1 :]:
    bpy.ops.wm.open_mainfile(filepath=path, load_ui=False, use_scripts=False)
    request = extract_engine.Request(compare=True)
    extraction = extract_engine.extract_now(bpy.context.scene, request)
    with extraction.model as model:
        count = model.totals().occurrences
    told = {
        "file": path,
        "occurrences": count,
        "shown": extraction.shown,
        "differences": request.differences,
    }
    print("DIFFERENCES " + json.dumps(told), flush=True)
