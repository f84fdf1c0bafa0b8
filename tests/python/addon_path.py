# SPDX-License-Identifier: GPL-3.0-or-later
"""Puts the add-on's folder and the binding on the path: `import lodestone` without Blender."""

import os
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PYTHON = Path(os.environ.get("LODESTONE_BUILD") or ROOT / "build" / "release") / "python"
for _folder in (ROOT / "blender_addon", PYTHON):
    if str(_folder) not in sys.path:
        sys.path.insert(0, str(_folder))
