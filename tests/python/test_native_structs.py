# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the binding against the header: sizes and offsets of every struct, every function."""

import ctypes
import importlib
import re
import shutil
import subprocess
import tempfile
import unittest
from dataclasses import fields
from enum import EnumMeta
from pathlib import Path

import addon_path
import lodestone_native
from lodestone_native import LodestoneError, Model, base, enums, functions, kind_counts, library
from lodestone_native import structs, view
from lodestone_native.job import Job

HEADER = addon_path.ROOT / "backend" / "include" / "lodestone" / "lodestone.h"


def c_name(thing):
    return "lds_" + re.sub(r"(?<!^)([A-Z])", r"_\1", thing.__name__).lower()


def bound_structs():
    found = []
    for value in vars(structs).values():
        if isinstance(value, type) and issubclass(value, ctypes.Structure):
            if hasattr(value, "_fields_") and value is not ctypes.Structure:
                found.append(value)
    return found


class Structs(unittest.TestCase):
    def test_every_struct_of_the_header_is_bound(self):
        named = set(re.findall(r"typedef struct (lds_\w+) \{", HEADER.read_text()))
        self.assertEqual({c_name(struct) for struct in bound_structs()}, named)

    def test_sizes_and_offsets_are_the_compilers(self):
        compiler = shutil.which("cc") or shutil.which("gcc")
        if compiler is None:
            self.skipTest("no C compiler")
        lines, expected = [], []
        for struct in bound_structs():
            name = c_name(struct)
            lines.append(f'printf("%zu\\n", sizeof({name}));')
            expected.append((name, ctypes.sizeof(struct)))
            for field, *_ in struct._fields_:
                lines.append(f'printf("%zu\\n", offsetof({name}, {field}));')
                expected.append((f"{name}.{field}", getattr(struct, field).offset))
        source = (
            '#include <stdio.h>\n#include "lodestone/lodestone.h"\n'
            "int main(void) {" + "\n".join(lines) + "return 0;}\n"
        )
        with tempfile.TemporaryDirectory() as folder:
            program = str(Path(folder) / "sizes")
            include = f"-I{HEADER.parents[1]}"
            subprocess.run(
                [compiler, "-x", "c", "-", include, "-o", program],
                input=source,
                text=True,
                check=True,
            )
            said = subprocess.run([program], capture_output=True, text=True, check=True).stdout
        actual = [int(line) for line in said.split()]
        for (name, ours), theirs in zip(expected, actual, strict=True):
            self.assertEqual(ours, theirs, name)

    def test_structs_that_grow_lie_in_no_other(self):
        def item(kind):
            return item(kind._type_) if issubclass(kind, ctypes.Array) else kind

        for struct in bound_structs():
            for name, kind in struct._fields_:
                self.assertFalse(issubclass(item(kind), base.Sized), f"{c_name(struct)}.{name}")

    def test_structs_that_grow_end_without_padding(self):
        """Else a new member could lie where an older caller's struct_size says that it has one."""
        for struct in bound_structs():
            if issubclass(struct, base.Sized):
                last = struct._fields_[-1][0]
                end = getattr(struct, last).offset + getattr(struct, last).size
                self.assertEqual(end, ctypes.sizeof(struct), f"{c_name(struct)}.{last}")

    def test_each_field_of_a_value_travels_in_its_struct(self):
        """A field that only one of the two has would be 0 without a word."""
        for value in (view.Camera, view.Light, view.Lens, view.ScreenLens, view.Modifiers,
                      view.Budget, view.View):  # fmt: skip
            named = {field for field, *_ in getattr(structs, value.__name__)._fields_}
            ours = {one.name for one in fields(value)}
            counts = {name for name in named - ours if name.endswith("_count")}
            self.assertEqual(ours, named - counts - {"struct_size", "unused"}, value.__name__)

    def test_each_modifier_is_handed_over(self):
        given = view.Modifiers(depth=2.0, depth_focus=3.0, when_moving=True, when_dark=True,
                               off_screen=enums.OffScreen.SHADOWS, ray_classes=enums.Rays.SHADOW,
                               criterion=enums.Criterion.AREA)  # fmt: skip
        struct = given.struct()
        for one in fields(given):
            if one.name not in ("lenses", "screen_lenses", "closing"):  # pointers
                self.assertNotEqual(getattr(given, one.name), one.default, one.name)
                self.assertEqual(getattr(struct, one.name), getattr(given, one.name), one.name)

    def test_struct_size_is_filled(self):
        self.assertEqual(structs.View().struct_size, ctypes.sizeof(structs.View))
        self.assertEqual(Job().struct_size, ctypes.sizeof(Job))

    def test_a_record_outlives_its_struct(self):
        struct = structs.ObjectSummary(uid=b"u", name="名".encode(), center=(1, 2, 3))
        copied = struct.record()
        del struct
        self.assertEqual((copied.uid, copied.name, copied.center), ("u", "名", (1.0, 2.0, 3.0)))


class Functions(unittest.TestCase):
    def test_every_function_of_the_header_is_declared_in_its_order(self):
        text = re.sub(r"/\*.*?\*/", "", HEADER.read_text(), flags=re.DOTALL)
        named = re.findall(r"LDS_API [^;(]*?(lds_\w+)\(", text)
        self.assertEqual([name for name, _, _ in functions.PROTOTYPES], named)

    def test_argument_counts_are_the_headers(self):
        text = re.sub(r"/\*.*?\*/", "", HEADER.read_text(), flags=re.DOTALL)
        for name, _, arguments in functions.PROTOTYPES:
            found = re.search(rf"\b{name}\(([^;]*)\);", text)
            listed = found[1].strip()
            count = 0 if listed == "void" else listed.count(",") + 1
            self.assertEqual(len(arguments), count, name)

    def test_abi_is_the_headers(self):
        found = re.search(r"#define LDS_ABI_VERSION (\d+)", HEADER.read_text())
        self.assertEqual(library.ABI_VERSION, int(found[1]))

    def test_enums_are_the_headers(self):
        text = HEADER.read_text()
        bound = {c_name(e) for e in vars(enums).values() if isinstance(e, EnumMeta)}
        self.assertEqual(bound - {"lds_int_enum"}, set(re.findall(r"typedef enum (\w+)", text)))
        for enum, prefix in (
            (enums.Stage, "LDS_STAGE_"),
            (enums.Role, "LDS_ROLE_"),
            (enums.RayClass, "LDS_RAY_"),
            (enums.Kind, "LDS_KIND_"),
            (enums.LensShape, "LDS_LENS_SHAPE_"),
            (enums.LensFilter, "LDS_LENS_FILTER_"),
            (enums.Criterion, "LDS_CRITERION_"),
            (enums.OffScreen, "LDS_OFF_SCREEN_"),
            (enums.Rays, "LDS_RAYS_"),
            (enums.Met, "LDS_MET_"),
            (enums.Drawn, "LDS_DRAWN_"),
            (enums.SimplifyMode, "LDS_SIMPLIFY_"),
            (enums.Channel, "LDS_CHANNEL_"),
            (enums.Extension, "LDS_EXTENSION_"),
            (enums.AlphaMode, "LDS_ALPHA_MODE_"),
            (enums.Antialias, "LDS_ANTIALIAS_"),
            (enums.LightKind, "LDS_LIGHT_"),
            (enums.BakeOp, "LDS_BAKE_"),
            (enums.Projection, "LDS_PROJECTION_"),
            (enums.Severity, "LDS_SEVERITY_"),
            (enums.Status, "LDS_ERROR_"),
        ):
            named = {n: int(v) for n, v in re.findall(rf"{prefix}(\w+) = (\d+)", text)}
            ours = {member.name: member.value for member in enum}
            ours.pop("OK", None)
            self.assertEqual(ours, named)

    def test_indirect_rays_are_the_classes_behind_the_cameras(self):
        classes = {one.name: one.value for one in enums.RayClass}
        self.assertEqual(classes.pop("CAMERA"), 1)
        self.assertEqual({one.name: 2 * one.value for one in enums.Rays}, classes)

    def test_the_library_knows_each_ray_class_and_no_other(self):
        known = sum(enums.RayClass)
        with Model() as model:
            group, leaf = model.add_group("group", "group"), model.add_group("leaf", "leaf")
            place = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)
            model.add_placement(group, leaf, place, "seen by none", hidden=known)
            with self.assertRaisesRegex(LodestoneError, "ray classes"):
                model.add_placement(group, leaf, place, "wrong", hidden=known + 1)

    def test_words_of_kinds_are_the_librarys(self):
        loaded = library.library()
        named = {k: loaded.lds_kind_name(k).decode() for k in range(-1, enums.KIND_COUNT + 1)}
        ours = {int(kind): kind.name.lower() for kind in enums.Kind}
        self.assertEqual({k: word for k, word in named.items() if word}, ours)
        counted = kind_counts(range(enums.KIND_COUNT))
        self.assertEqual(counted, {w: k for k, w in ours.items() if w != "assembly"})


class Cameras(unittest.TestCase):
    def test_those_of_a_model_are_read_back(self):
        given = view.Camera("Über", True, (1, 2, 3), (0, 1, 0), (1, 0, 0), (0, 0, 1), 0.25, 4.0)
        with Model() as model:
            model.add_camera(given)
            self.assertEqual(model.cameras(), [given])


class Names(unittest.TestCase):
    def test_each_is_that_of_its_module(self):
        for module, names in lodestone_native.NAMES.items():
            home = importlib.import_module(f"lodestone_native.{module}")
            self.assertIs(getattr(lodestone_native, module), home)
            for name in names.split():
                self.assertIs(getattr(lodestone_native, name), getattr(home, name))
                self.assertIn(name, dir(lodestone_native))

    def test_a_wrong_name_is_an_attribute_error(self):
        with self.assertRaisesRegex(AttributeError, "no attribute 'Modle'"):
            lodestone_native.Modle


class Loading(unittest.TestCase):
    def said_of(self, library):
        """What a fresh process prints that wants this file as its library."""
        code = (
            "import lodestone_native as n\n"
            "try:\n n.version()\n"
            "except n.LodestoneError as error:\n print(error)\n"
        )
        return subprocess.run(
            ["/usr/bin/python3", "-c", code],
            capture_output=True,
            text=True,
            check=True,
            env={"PYTHONPATH": str(addon_path.PYTHON), "LODESTONE_LIBRARY": library},
        ).stdout

    def test_a_missing_library_is_a_sentence(self):
        missing = "/nowhere/liblodestone.so"
        self.assertIn(missing, self.said_of(missing))

    def test_a_foreign_library_is_a_sentence(self):
        self.assertIn("cannot be loaded", self.said_of(__file__))


if __name__ == "__main__":
    unittest.main()
