# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the JSON report: whole or not there, and readable whatever names it quotes."""

import json
import os
import tempfile
import unittest
from pathlib import Path

import addon_path  # noqa: F401
from lodestone.core import run_report
from lodestone.core.exit_codes import ExitCode
from lodestone.core.problems import ERROR, WARNING, Problems


class Report(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name) / "report.json"

    def test_says_what_and_how(self):
        made = run_report.file_report("render", "a.blend", ExitCode.POVRAY, "POV-Ray is missing")
        self.assertEqual(made["schema"], 1)
        self.assertEqual((made["status"], made["exit_code"]), ("povray_failed", 5))

    def test_reads_back_with_any_name(self):
        problems = Problems()
        names = ['quote"', "new\nline", "{brace}", "名前", "\udcff"]
        for name in names:
            problems.add(name, WARNING, "texture_mean", f"Material {name}")
        value = {"problems": run_report.problems_part(problems)}
        run_report.write(self.path, value)
        found = json.loads(self.path.read_text("utf-8"))["problems"]
        self.assertEqual([p["object"] for p in found[:4]], names[:4])
        self.assertEqual(len(found), 5)

    def test_has_the_rights_that_the_user_gives_new_files(self):
        before = os.umask(0o027)
        try:
            run_report.write(self.path, {})
        finally:
            os.umask(before)
        self.assertEqual(self.path.stat().st_mode & 0o777, 0o640)

    def test_a_failed_write_keeps_the_old_one_and_leaves_nothing(self):
        run_report.write(self.path, {"old": 1})
        with self.assertRaises(TypeError):
            run_report.write(self.path, {"bad": object()})
        self.assertEqual(json.loads(self.path.read_text()), {"old": 1})
        self.assertEqual(os.listdir(self.path.parent), ["report.json"])

    def test_several_files_are_all_in_it(self):
        one = run_report.file_report("build", "a.blend", ExitCode.DONE)
        two = run_report.file_report("build", "b.blend", ExitCode.UNREADABLE)
        whole = run_report.many_report("build", [one, two], ExitCode.FAILED)
        self.assertEqual([f["exit_code"] for f in whole["files"]], [0, 4])
        self.assertEqual(whole["exit_code"], 1)


class ProblemList(unittest.TestCase):
    def test_each_cause_of_a_thing_counts_once(self):
        problems = Problems()
        for _ in range(3):
            problems.add("Bark", WARNING, "texture_mean", "first")
        problems.add("Bark", ERROR, "mesh_unreadable", "other")
        self.assertEqual(len(problems), 2)
        self.assertEqual([p.code for p in problems.wrong], ["mesh_unreadable"])

    def test_takes_the_librarys_and_calls_an_unknown_severity_an_error(self):
        class Native:
            object, code, message = "Cube", "nan_vertices", "left out"

            def __init__(self, severity):
                self.severity = severity

        problems = Problems()
        problems.extend_native([Native(1)])
        self.assertEqual([p.severity for p in problems], ["warning"])
        problems = Problems()
        problems.extend_native([Native(9)])
        self.assertEqual([p.severity for p in problems], ["error"])


if __name__ == "__main__":
    unittest.main()
