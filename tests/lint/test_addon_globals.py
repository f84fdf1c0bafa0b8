# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards that the add-on remembers scenes, viewports and what runs in its session, nowhere else."""

import ast
import unittest

from repository import ROOT, files

ADDON = "blender_addon/lodestone/"
# What belongs to the add-on's coming and going itself, or is never the same twice
ALLOWED = {
    "__init__.py _loaded": "the modules that are registered",
    "panels/__init__.py _loaded": "the panels that are registered",
    "core/session/addon_session.py _session": "the session",
    "engines/render_engine.py _leaving": "survives the end of the session: a render may still run",
    "engines/render_job.py _waiting": "what ends the session once no render runs",
    "viewport/false_color_overlay.py _handle": "Blender's handle of a drawing function",
    "viewport/lens_overlay.py _handles": "Blender's handles of drawing functions",
    "viewport/levels_preview.py _numbers": "a counter",
    "bridge/live/preview_changes.py _states": "a counter",
}
MUTABLE = (ast.Dict, ast.List, ast.Set, ast.Call, ast.DictComp, ast.ListComp, ast.SetComp)


def is_variable(name: str) -> bool:
    """Constants are in capitals; `register` and the like are functions."""
    return name.startswith("_") and not name.startswith("__") and name != name.upper()


def states(text: str) -> set[str]:
    """The names at the top of a module that may hold something else later."""
    tree, found = ast.parse(text), set()
    for node in tree.body:
        targets = node.targets if isinstance(node, ast.Assign) else []
        targets = [node.target] if isinstance(node, ast.AnnAssign) else targets
        if targets and isinstance(node.value, MUTABLE):
            found |= {t.id for t in targets if isinstance(t, ast.Name) and is_variable(t.id)}
    for node in ast.walk(tree):
        if isinstance(node, ast.Global):
            found |= set(node.names)
    return found


class Globals(unittest.TestCase):
    def test_the_check_finds_what_it_is_for(self):
        self.assertEqual(states("_cache = {}\n_all: dict[str, int] = dict()\n"), {"_cache", "_all"})
        self.assertEqual(states("_now = None\ndef f():\n    global _now\n    _now = 1\n"), {"_now"})
        self.assertEqual(states("_MOST = dict(a=1)\n_CLASSES = []\n_FORM: set = set()\n"), set())
        self.assertEqual(states("def f():\n    _found = {}\n"), set())

    def test_nothing_is_remembered_outside_of_the_session(self):
        found = set()
        for name in files():
            if name.startswith(ADDON) and name.endswith(".py"):
                text = (ROOT / name).read_text(encoding="utf-8")
                found |= {f"{name.removeprefix(ADDON)} {state}" for state in states(text)}
        self.assertEqual(found, set(ALLOWED))


if __name__ == "__main__":
    unittest.main()
