# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the floors of the design: no include and no import points up, no library leaks."""

import tempfile
import unittest
from pathlib import Path

import check_layers
from repository import ROOT, files


def broken_rules(tree: dict[str, str]) -> list[str]:
    """The rules that a tree of files {name: text} breaks."""
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        for name, text in tree.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text, encoding="utf-8")
        return check_layers.check_tree(root, sorted(tree))


class TheCheck(unittest.TestCase):
    def assert_right(self, name: str, text: str):
        self.assertEqual(broken_rules({name: text}), [])

    def assert_wrong(self, name: str, text: str, words: str):
        found = broken_rules({name: text})
        self.assertEqual(len(found), 1, found)
        self.assertIn(name, found[0])
        self.assertIn(words, found[0])

    def test_empty_tree_and_empty_file_break_nothing(self):
        self.assertEqual(broken_rules({}), [])
        self.assert_right("backend/src/base/a.h", "")

    def test_includes_may_point_down_or_sideways(self):
        self.assert_right("backend/src/model/a.cpp", '#include "base/b.h"\n#include "model/c.h"\n')
        self.assert_right("povray_export/a.cpp", '#include "choose/cut.h"\n#include <string>\n')
        self.assert_right("backend/src/capi/a.cpp", '#include "lodestone/lodestone.h"\n')

    def test_includes_may_not_point_up(self):
        self.assert_wrong("backend/src/base/a.h", '#include "model/mesh.h"', "above base")
        self.assert_wrong(
            "backend/src/hierarchy/a.h", '  # include "povray_export/x.h"', "above hierarchy"
        )
        self.assert_wrong("backend/src/ray/a.cpp", '#include "../capi/x.h"', "climbs out")
        self.assert_wrong("backend/src/ray/a.cpp", '#include "ray.h"', "on no floor")
        self.assert_wrong("backend/src/ray/a.cpp", '#include "lodestone/lodestone.h"', "only capi")

    def test_a_neighbor_may_be_named_without_its_floor(self):
        tree = {"backend/src/ray/a.cpp": '#include "b.h"', "backend/src/ray/b.h": ""}
        self.assertEqual(broken_rules(tree), [])

    def test_a_folder_that_is_no_floor_is_named(self):
        self.assert_wrong("backend/src/helpers/a.cpp", "", "no floor of the design")

    def test_the_command_sees_the_c_interface_alone(self):
        self.assert_right("backend/tools/main.cpp", '#include "lodestone/lodestone.h"')
        self.assert_wrong("backend/tools/main.cpp", '#include "model/mesh.h"', "its own folder")
        self.assert_wrong("tests/capi/test_abi.c", '#include "model/mesh.h"', "its own folder")

    def test_libraries_stay_in_their_folders(self):
        for folder, header in (
            ("ray", "embree3/rtcore.h"),
            ("image", "png.h"),
            ("image", "jpeglib.h"),
            ("image", "OpenEXR/ImfRgbaFile.h"),
            ("image", "ImfRgbaFile.h"),
            ("format", "tiny_gltf.h"),
            ("format", "meshoptimizer.h"),
            ("geometry", "OpenMesh/Core/IO/MeshIO.hh"),
        ):
            with self.subTest(header):
                name = "repair.cpp" if folder == "geometry" else "a.cpp"
                self.assert_right(f"backend/src/{folder}/{name}", f"#include <{header}>")
                self.assert_wrong("backend/src/base/a.cpp", f"#include <{header}>", "may not see")
                self.assert_wrong(
                    f"backend/src/{folder}/repair.h", f"#include <{header}>", "in a header"
                )
        self.assert_right("backend/src/base/parallel.cpp", "#include <tbb/parallel_for.h>")
        self.assert_wrong("backend/src/base/a.cpp", "#include <tbb/parallel_for.h>", "may not see")
        self.assert_wrong("backend/src/base/a.cpp", "#include <boost/any.hpp>", "no rule")

    def test_only_glm_appears_in_headers(self):
        self.assert_right("backend/src/base/a.h", "#include <glm/vec3.hpp>\n#include <vector>")
        self.assert_right("backend/src/base/a.cpp", "#include <nlohmann/json.hpp>")
        self.assert_wrong("backend/src/base/a.h", "#include <nlohmann/json.hpp>", "may not see")
        self.assert_wrong("backend/include/lodestone/lodestone.h", "#include <glm/vec3.hpp>", "")

    def test_a_header_that_shows_a_library_stays_in_its_folder(self):
        self.assert_right("backend/src/segment/json_values.h", "#include <nlohmann/json.hpp>")
        self.assert_right("backend/src/segment/a.cpp", '#include "segment/json_values.h"')
        self.assert_wrong(
            "backend/src/hierarchy/a.cpp", '#include "segment/json_values.h"', "its own folder"
        )

    def test_imports_may_point_down(self):
        self.assert_right("blender_addon/lodestone/panel.py", "import bpy\nfrom .core import x\n")
        self.assert_right("blender_addon/lodestone/bridge/mesh.py", "from ..core.cut import Cut\n")
        self.assert_right("blender_addon/lodestone/core/a.py", "from .. import lodestone_native\n")
        self.assert_right("backend/python/lodestone_native/a.py", "from . import types\n")

    def test_imports_may_not_point_up(self):
        place = "blender_addon/lodestone/"
        self.assert_wrong(place + "core/a.py", "from ..bridge import mesh", "above")
        self.assert_wrong(place + "core/a.py", "from .. import bridge", "above")
        self.assert_wrong(place + "bridge/a.py", "from ..panels import x", "above")
        self.assert_wrong(place + "bridge/a.py", "def f():\n    import lodestone.ui", "above")
        self.assert_wrong("backend/python/lodestone_native/a.py", "import lodestone.core", "above")

    def test_rooms_of_the_add_on_import_downwards(self):
        place = "blender_addon/lodestone/"
        self.assert_right(place + "core/preview/a.py", "from ..picture import cost_model\n")
        self.assert_right(place + "core/picture/a.py", "from . import b\nfrom .. import problems\n")
        self.assert_right(place + "bridge/motion/a.py", "from ...core.session import edits\n")
        self.assert_wrong(place + "core/picture/a.py", "from ..preview import b", "above")
        self.assert_wrong(place + "core/picture/a.py", "from .. import batch", "above")
        self.assert_wrong(place + "core/problems.py", "from .store import store_path", "above")
        self.assert_wrong(place + "bridge/motion/a.py", "from ..scene import b", "above")
        self.assert_wrong(place + "bridge/nodes/a.py", "import lodestone.bridge.world.b", "above")
        self.assert_right(place + "operators/a.py", "from ..engines import b\n")
        self.assert_right(place + "panels/a.py", "from ..operators import b\n")
        self.assert_wrong(place + "operators/a.py", "from ..panels import b", "above")
        self.assert_wrong(place + "viewport/a.py", "from ..operators import b", "above")

    def test_a_folder_of_the_add_on_is_a_room_with_a_height(self):
        place = "blender_addon/lodestone/"
        for floor in ("core", "bridge"):
            self.assert_wrong(f"{place}{floor}/attic/a.py", "import math\n", "no room")
            self.assert_wrong(f"{place}{floor}/attic/b/a.py", "import math\n", "no room")
        self.assert_wrong(f"{place}attic/a.py", "import math\n", "no room")

    def test_bpy_stays_above_core(self):
        for text in ("import bpy", "from bpy.types import Mesh", "def f():\n    import mathutils"):
            with self.subTest(text):
                self.assert_wrong("blender_addon/lodestone/core/a.py", text, "below bridge")
                self.assert_wrong("backend/python/lodestone_native/a.py", text, "below bridge")
                self.assert_right("blender_addon/lodestone/bridge/a.py", text)

    def test_numpy_is_nowhere(self):
        for text in ("import numpy as np", "from numpy.linalg import norm"):
            with self.subTest(text):
                self.assert_wrong("blender_addon/lodestone/panel.py", text, "numpy")
                self.assert_wrong("backend/python/lodestone_native/a.py", text, "numpy")


class TheRepository(unittest.TestCase):
    def test_no_rule_is_broken(self):
        found = check_layers.check_tree(ROOT, list(files()))
        if found:
            self.fail("\n" + "\n".join(found))

    def test_the_check_sees_every_folder_there_is(self):
        for folder, ending in (
            ("backend/src/base", ".cpp"),
            ("backend/src/capi", ".cpp"),
            ("backend/tools", ".cpp"),
            ("povray_export", ".cpp"),
            ("blender_addon/lodestone/core", ".py"),
            ("backend/python/lodestone_native", ".py"),
        ):
            if any((ROOT / folder).glob("*" + ending)):
                seen = [f for f in files() if f.startswith(folder + "/") and f.endswith(ending)]
                self.assertTrue(seen, folder)


if __name__ == "__main__":
    unittest.main()
