# SPDX-License-Identifier: GPL-3.0-or-later
"""Puts the add-on's folder on the path: `import lodestone` without Blender."""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
for _folder in (ROOT / "blender_addon", ROOT / "backend" / "python"):
    if str(_folder) not in sys.path:
        sys.path.insert(0, str(_folder))
