# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards pages that programs write: a bench's page of results, and the block of README.md that the
street's comparison writes."""

import argparse
import contextlib
import io
import json
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))
sys.path.insert(0, str(ROOT / "samples" / "street"))

from bench import benching  # noqa: E402
from report import BEGIN, END, strip_block, with_strip  # noqa: E402

README = (ROOT / "README.md").read_text("utf-8")


def row(picture: str, triangles: int, trace: float) -> dict:
    return {
        "picture": picture,
        "triangles": triangles,
        "memory_bytes": 41.4e6,
        "export_cpu_s": 0.0,
        "parse_cpu_s": 0.33,
        "trace_cpu_s": trace,
        "ssim": 0.9342,
    }


def report(built: int = 7, cpu_s: float = 40.2) -> dict:
    rows = [row("full", 9996048, 9.28), row("0.5px", 1289818, 5.89), row("1px", 582119, 2.54)]
    rows += [row("2px", 204942, 2.2), row("4px", 79770, 1.6)]
    return {"cameras": {"far": rows}, "build": {"built": built, "cpu_s": cpu_s}}


class ResultsPages(unittest.TestCase):
    def written(self, path: Path, table: list[str], data: dict) -> tuple[str, dict]:
        with contextlib.redirect_stdout(io.StringIO()):
            benching.write_results(path, "Trees", table, data)
        page = path.with_suffix(".md").read_text("utf-8")
        return page, json.loads(path.with_suffix(".json").read_text("utf-8"))

    def test_page_and_json_tell_table_machine_date_commit_and_command(self):
        with tempfile.TemporaryDirectory() as folder:
            table = ["| a |", "|---|", "| 1.5 |"]
            path = Path(folder) / "new" / "trees"
            page, data = self.written(path, table, {"load_before": 0.25, "found": [1.5]})
        self.assertTrue(page.startswith("# Trees\n\nWritten by `"), page)
        self.assertTrue(page.endswith("\n\n| a |\n|---|\n| 1.5 |\n"), page)
        self.assertIn(", load 0.2", page)
        for key in ("command", "machine", "date", "commit"):
            self.assertIn(data[key], page)
            self.assertTrue(data[key], key)
        self.assertEqual((data["schema"], data["title"], data["found"]), (1, "Trees", [1.5]))

    def test_no_path_of_this_machine_is_written(self):
        with tempfile.TemporaryDirectory() as folder:
            inputs = [str(ROOT / "build/a.blend"), str(ROOT.parent / "shared/b.ply")]
            _, data = self.written(Path(folder) / "x", [], {"input": inputs})
        self.assertEqual(data["input"], ["build/a.blend", "../shared/b.ply"])

    def test_the_commands_words_are_kept_but_for_write(self):
        before, sys.argv = sys.argv, [str(ROOT / "tests/bench/b.py"), "--write", "--rounds", "2"]
        self.addCleanup(setattr, sys, "argv", before)
        with tempfile.TemporaryDirectory() as folder:
            _, data = self.written(Path(folder) / "x", [], {})
        self.assertEqual(data["command"], "tests/bench/b.py --rounds 2")

    def test_pages_go_below_build_unless_they_are_asked_for(self):
        parser = argparse.ArgumentParser()
        benching.add_write(parser, "backend")
        usual, asked = parser.parse_args([]), parser.parse_args(["--write"])
        self.assertEqual(
            benching.results_path(usual, "cut"), ROOT / "build" / "bench" / "results" / "cut"
        )
        self.assertEqual(
            benching.results_path(asked, "cut"), ROOT / "backend" / "docs" / "results" / "cut"
        )

    def test_what_is_told_is_printed_and_kept_line_by_line(self):
        printed, told = io.StringIO(), benching.Told()
        with contextlib.redirect_stdout(printed):
            told.tell("a\nb")
            told.tell()
        self.assertEqual((list(told), printed.getvalue()), (["a", "b", ""], "a\nb\n\n"))


class StripBlock(unittest.TestCase):
    def test_rows_are_those_of_the_far_camera_in_the_form_of_the_page(self):
        lines = strip_block(report()).splitlines()
        self.assertEqual(lines[2], "| full detail | 9,996,048 | 41 MB | 0.3 + 9.3 CPU s | 0.934 |")
        one = "| **Pixel Error 1** | **582,119** | **41 MB** | **0.3 + 2.5 CPU s** | **0.934** |"
        self.assertEqual(lines[4], one)
        self.assertEqual([line.split(" |")[0] for line in lines[5:6]], ["| Pixel Error 4"])
        self.assertIn("took 40 CPU s once: paid back\nafter 6 pictures", strip_block(report()))

    def test_levels_that_were_there_or_never_pay_are_told_without_a_number(self):
        self.assertNotIn("Building", strip_block(report(built=0)))
        never = report()
        never["cameras"]["far"][2]["trace_cpu_s"] = 10.0
        self.assertTrue(strip_block(never).endswith("took 40 CPU s once."), strip_block(never))

    def test_only_what_is_between_the_marks_changes(self):
        page = f"a\n{BEGIN}\nold\n{END}\nb\n"
        self.assertEqual(with_strip(page, "new\nrows"), f"a\n{BEGIN}\nnew\nrows\n{END}\nb\n")
        self.assertEqual(with_strip(with_strip(page, "x"), "old"), page)

    def test_a_page_without_the_marks_once_is_refused(self):
        for page in ("", BEGIN, END, f"{END}{BEGIN}", f"{BEGIN}{END}{BEGIN}{END}"):
            with self.assertRaises(ValueError, msg=page):
                with_strip(page, "new")

    def test_the_first_page_has_the_marks_and_the_head_that_is_written(self):
        shown = README.partition(BEGIN)[2].partition(END)[0].strip().splitlines()
        new = strip_block(report()).splitlines()
        self.assertEqual(shown[:2], new[:2])
        rows = [[line.split("|")[1] for line in part[2:6]] for part in (shown, new)]
        self.assertEqual(rows[0], rows[1])
        self.assertEqual(with_strip(README, "\n".join(shown)), README)


if __name__ == "__main__":
    unittest.main()
