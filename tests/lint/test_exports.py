# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the C interface: the library exports what the header declares, and all of it is tested."""

import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

from repository import ROOT, files, run, text_of

HEADER = "backend/include/lodestone/lodestone.h"
LIBRARY = Path(os.environ.get("LODESTONE_BUILD", ROOT / "build/release")) / (
    "backend/liblodestone.so"
)


def declared_functions(header: str) -> set[str]:
    """Names of the functions that the text of a header declares with LDS_API."""
    code = re.sub(r"/\*.*?\*/|//[^\n]*", " ", header, flags=re.DOTALL)
    return {
        match.group(1)
        for match in re.finditer(r"^LDS_API\b[^;(]*?\b(\w+)\s*\(", code, flags=re.MULTILINE)
    }


def exported_symbols(library: Path) -> set[str]:
    """Everything other programs can link to in a shared library."""
    done = subprocess.run(
        ["nm", "--dynamic", "--defined-only", "--format=posix", str(library)],
        check=True,
        capture_output=True,
        text=True,
    )
    return {line.split()[0] for line in done.stdout.splitlines()}


def untested(functions: set[str], tests: list[str]) -> set[str]:
    """The functions whose name is a word of none of the texts."""
    words = set().union(*(re.findall(r"\blds_\w+", text) for text in tests))
    return functions - words


class TheCheck(unittest.TestCase):
    def test_declarations_are_found_in_any_shape(self):
        header = """
            #define LDS_API __attribute__((visibility("default")))
            /* LDS_API int lds_in_a_comment(void); */
            """.replace(
            "            ", ""
        )
        header += (
            "LDS_API const char* lds_one(int a,\n    int b);\nLDS_API lds_status\nlds_two(void);"
        )
        self.assertEqual(declared_functions(header), {"lds_one", "lds_two"})
        self.assertEqual(declared_functions(""), set())

    def test_a_function_no_test_names_is_found(self):
        self.assertEqual(untested({"lds_a", "lds_ab"}, ["x = lds_ab(1)"]), {"lds_a"})

    def test_an_extra_symbol_is_found(self):
        with tempfile.TemporaryDirectory() as folder:
            library = Path(folder) / "x.so"
            source = Path(folder) / "x.c"
            source.write_text("int lds_one(void){return 1;} static int f(void){return 2;}\nint g;")
            done = run("cc", "-shared", "-fPIC", "-w", "-o", str(library), str(source))
            self.assertEqual(done.returncode, 0, done.stdout)
            self.assertEqual(exported_symbols(library), {"lds_one", "g"})


class TheInterface(unittest.TestCase):
    maxDiff = None

    def setUp(self):
        self.declared = declared_functions(text_of(HEADER))
        self.assertGreater(len(self.declared), 5)
        self.assertTrue(all(name.startswith("lds_") for name in self.declared))

    def test_the_header_is_c11_alone(self):
        for language in (["-x", "c", "-std=c11"], ["-x", "c++", "-std=c++20"]):
            done = run(
                "g++",
                *language,
                *("-Wall", "-Wextra", "-Werror", "-pedantic-errors", "-fsyntax-only"),
                HEADER,
            )
            self.assertEqual(done.returncode, 0, done.stdout)

    def test_the_library_exports_what_the_header_declares(self):
        self.assertEqual(exported_symbols(LIBRARY), self.declared)

    def test_every_function_is_named_by_a_test(self):
        tests = [
            text_of(name)
            for name in files()
            if re.fullmatch(r"tests/(?!lint/).*\.(py|c|cpp)", name)
        ]
        self.assertEqual(untested(self.declared, tests), set())


if __name__ == "__main__":
    unittest.main()
