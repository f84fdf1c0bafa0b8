# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the maker of the binding on small headers: what it makes, and that it refuses the rest."""

import ctypes
import importlib
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import addon_path

SCRIPT = addon_path.ROOT / "backend" / "python" / "generate_binding.py"
sys.path.append(str(SCRIPT.parent))  # the last: lodestone_native there is not whole

import c_header  # noqa: E402
import generate_binding  # noqa: E402

BY_HAND = SCRIPT.parent / "lodestone_native"
SMALL = """/* A header. */
#ifndef SMALL_H
#include <stdint.h>
#ifdef __cplusplus
extern "C" {
#endif
/* How many. */
#define LDS_COUNT 3
typedef struct lds_model lds_model;
/* Colors {of things}. */
typedef enum lds_paint { LDS_PAINT_RED = 1, /* warm "red" */ LDS_PAINT_BLUE = 4 } lds_paint;
typedef enum lds_status { LDS_OK = 0, LDS_ERROR_IO = 10 } lds_status;
typedef struct lds_object {
    uint32_t index;
    uint32_t generation;
} lds_object;
typedef struct lds_shape {
    uint32_t struct_size;
    const struct lds_point* points; /* declared below */
    size_t point_count;
} lds_shape;
typedef struct lds_point {
    float x[LDS_COUNT];
} lds_point;
typedef struct lds_report {
    uint32_t struct_size;
    /* Before its
       line. */
    const char* name;
    double center[3]; /* metres,
                         with {0, 0} */
    lds_object object;
    const void* bytes_at;
} lds_report;
/* Fills it. */
LDS_API lds_status lds_model_report(lds_model* model, lds_paint paint, double scale[2],
                                    lds_report* out_report);
LDS_API void lds_model_destroy(lds_model* model);
LDS_API lds_status lds_model_create(lds_model** out_model);
LDS_API const char* lds_version(void);
#ifdef __cplusplus
}
#endif
#endif /* SMALL_H */
"""


class Made(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.out = self.folder / "made_native"

    def make(self, text):
        header = self.folder / "small.h"
        header.write_text(text, encoding="utf-8")
        command = ["/usr/bin/python3", "-B", SCRIPT, "--header", header, "--out", self.out]
        by_hand = self.folder / "by_hand"
        by_hand.mkdir(exist_ok=True)
        (by_hand / "__init__.py").write_text("")
        (by_hand / "base.py").write_text((BY_HAND / "base.py").read_text())
        return subprocess.run(
            [*command, "--package", by_hand], capture_output=True, text=True, check=False
        )

    def modules(self, text):
        done = self.make(text)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        sys.path.insert(0, str(self.folder))
        try:
            for name in [n for n in sys.modules if n.split(".")[0] == "made_native"]:
                del sys.modules[name]
            importlib.invalidate_caches()
            names = ("enums", "structs", "records", "functions")
            return [importlib.import_module(f"made_native.{name}") for name in names]
        finally:
            sys.path.pop(0)

    def test_an_empty_header_makes_an_empty_binding(self):
        enums, structs, records, functions = self.modules("")
        self.assertEqual(functions.PROTOTYPES, ())

    def test_the_smallest_function(self):
        *_, functions = self.modules("LDS_API void lds_nothing(void);")
        self.assertEqual(functions.PROTOTYPES, (("lds_nothing", None, []),))

    def test_a_small_header(self):
        enums, structs, records, functions = self.modules(SMALL)
        self.assertEqual(enums.COUNT, 3)
        self.assertEqual([(m.name, m.value) for m in enums.Paint], [("RED", 1), ("BLUE", 4)])
        self.assertEqual([(m.name, m.value) for m in enums.Status], [("OK", 0), ("IO", 10)])
        self.assertEqual(enums.Paint.__doc__, "Colors {of things}.")
        fields = dict(structs.Shape._fields_)
        self.assertEqual(fields["points"], ctypes.POINTER(structs.Point))
        self.assertEqual(dict(structs.Point._fields_)["x"], ctypes.c_float * 3)
        self.assertEqual(structs.Shape().struct_size, ctypes.sizeof(structs.Shape))
        self.assertEqual(structs.Object(1, 2), structs.Object(1, 2))
        model, text, status = ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int32
        numbers, out = ctypes.POINTER(ctypes.c_double), ctypes.POINTER(structs.Report)
        expected = (
            ("lds_model_report", status, [model, status, numbers, out]),
            ("lds_model_destroy", None, [model]),
            ("lds_model_create", status, [ctypes.POINTER(model)]),
            ("lds_version", text, []),
        )
        self.assertEqual(functions.PROTOTYPES, expected)

    def test_a_struct_that_a_call_fills_has_a_record(self):
        _, structs, records, _ = self.modules(SMALL)
        struct = structs.Report(name="名".encode(), center=(1, 2, 3), object=structs.Object(4, 5))
        kept = struct.record()
        self.assertIsInstance(kept, records.Report)
        self.assertEqual((kept.name, kept.center), ("名", (1.0, 2.0, 3.0)))
        struct.object.index = 9
        self.assertEqual(kept.object, structs.Object(4, 5))
        self.assertFalse(hasattr(structs.Shape, "record"))

    def test_comments_come_along(self):
        self.make(SMALL)
        structs = (self.out / "structs.py").read_text()
        self.assertIn('("name", c_char_p),  # Before its line.', structs)
        self.assertIn('("center", c_double * 3),  # metres, with {0, 0}', structs)
        self.assertIn('RED = 1  # warm "red"', (self.out / "enums.py").read_text())
        self.assertIn('"""Fills it."""', (self.out / "functions.pyi").read_text())

    def test_hostile_comments_stay_comments(self):
        hostile = '/* a \\ b """ import os */\ntypedef enum lds_a { LDS_A_B = 1 } lds_a;'
        enums, *_ = self.modules(hostile)
        self.assertEqual(enums.A.__doc__, 'a \\ b """ import os')

    def test_what_is_not_understood_is_named_with_its_line(self):
        for text, said in (
            ("typedef int lds_number;", "small.h:1: not understood: 'typedef int lds_number;'"),
            ("\n\nLDS_API long lds_a(void);", "small.h:3: unknown type 'long'"),
            ("LDS_API void lds_a(lds_b* b);", "small.h:1: unknown type 'lds_b*'"),
            ("LDS_API void lds_a(int32_t n, ...);", "small.h:1: not understood"),
            ("LDS_API void lds_a(void (*call)(void));", "small.h:1: not understood"),
            ("LDS_API void lds_a(char letter);", "small.h:1: unknown type 'char'"),
            ("LDS_API void lds_a(int32_t** rows);", "small.h:1: unknown type 'int32_t**'"),
            ("/* a */ // b\n", "small.h:1: not understood: '// b'"),
            ("/* never closed", "small.h:1: not understood: '/* never closed'"),
            ("#pragma pack(1)\n", "small.h:1: not understood: '#pragma pack(1)'"),
            ("#define LDS_TWICE(x) (2 * x)\n", "small.h:1: not understood"),
            ("#define LDS_A LDS_B\n", "small.h:1: 'LDS_B' is no number"),
            ("typedef enum lds_a {\n LDS_A_B = 1,\n LDS_A_C } lds_a;", "small.h:3: not understood"),
            ("typedef enum lds_a { LDS_A_B = 1 << 3 } lds_a;", "small.h:1: not understood: '<< 3"),
            ("typedef struct lds_a {\n int32_t b : 3;\n} lds_a;", "small.h:2: not understood"),
            ("typedef struct lds_a {\n int32_t b, c;\n} lds_a;", "small.h:2: not understood"),
            (
                "typedef struct lds_a {\n int32_t b[SIZE];\n} lds_a;",
                "small.h:2: 'SIZE' is no number",
            ),
            (
                "typedef struct lds_a {\n double* b[3];\n} lds_a;",
                "small.h:2: unknown type 'double*'",
            ),
            (
                "typedef struct lds_a {\n int32_t in;\n} lds_a;",
                "small.h:2: 'in' is a word of Python",
            ),
            (
                "typedef struct lds_a {\n union { int32_t b; } c;\n} lds_a;",
                "small.h:2: not understood",
            ),
            (
                "typedef struct lds_a {\n#if 1\n int32_t b;\n#endif\n} lds_a;",
                "small.h:4: not understood: '#endif'",
            ),
            ("typedef struct lds_a {\n} lds_a;", "small.h:1: lds_a has no fields"),
            (
                "typedef struct lds_a {\n struct lds_a* next;\n} lds_a;",
                "lds_a holds or points to itself",
            ),
            (
                "typedef struct lds_a {\n uint32_t struct_size;\n float* b;\n} lds_a;\n"
                "LDS_API void lds_c(lds_a* out_a);",
                "b: a record holds no pointer",
            ),
        ):
            with self.subTest(text):
                with self.assertRaises(c_header.HeaderError) as caught:
                    generate_binding.package(c_header.read("small.h", text))
                self.assertIn(said, str(caught.exception))

    def test_an_error_is_a_sentence_and_makes_nothing(self):
        done = self.make("typedef int lds_number;")
        said = "generate_binding: small.h:1: not understood: 'typedef int lds_number;'\n"
        self.assertEqual((done.returncode, done.stderr), (1, said))
        self.assertFalse(self.out.exists())

    def test_a_file_that_is_gone_is_gone_and_others_are_not_touched(self):
        self.make(SMALL)
        (self.out / "old.py").write_text("")
        before = (self.out / "structs.py").stat().st_mtime_ns
        self.make(SMALL)
        self.assertFalse((self.out / "old.py").exists())
        self.assertEqual((self.out / "structs.py").stat().st_mtime_ns, before)


if __name__ == "__main__":
    unittest.main()
