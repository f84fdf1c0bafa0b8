# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the page and the table of a batch run: failed first, and no name is more than text."""

import tempfile
import unittest
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

import addon_path  # noqa: F401
from lodestone.core import run_report
from lodestone.core.batch import html_page
from lodestone.core.batch.report_rows import rows_of, table, tally
from lodestone.core.exit_codes import ExitCode
from lodestone.core.printable_text import printable

HOSTILE = (
    "<script>alert(1)</script>",
    '"><img src=x onerror=alert(1)>',
    "' onmouseover='alert(1)",
    "</style></title></table><iframe src=//x>",
    "&lt;&#x3c;script&#x3e;",
    "javascript:alert(1)",
    "new\nline\r\ttab\x1b[31m\x00",
    "\u202egnp.exe",
    "\udcff\ud800",
    "名前 é 🐸",
)


def made(name, code=ExitCode.DONE, **values):
    return {**run_report.file_report("render", f"/scenes/{name}.blend", code), **values}


def cut(triangles, error, name="Tree"):
    return {"triangles": triangles, "largest_error_px": error, "largest_error_name": name}


def compared(name, ssim, worst="Scene/Tree"):
    """What batch.py compare reports."""
    found = {"mean": 0.01, "p999": 0.5, "max": 1.0, "ssim": ssim, "pixels": 9}
    found["worst"] = [{"object": worst, "share": 0.7}]
    before = {"cut": cut(9000, 0.0), "povray": {"wall_s": 12.5}}
    parts = {"cut": cut(90, 1.5), "povray": {"wall_s": 2.0}}
    return made(name, compare=found, originals=before, picture=f"/out/{name}.png", **parts)


class Reader(HTMLParser):
    """Collects what a browser would see."""

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.tags, self.attributes, self.text, self.rows = [], [], "", []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        self.attributes += attributes
        if tag == "tr":
            self.rows.append("")

    def handle_data(self, data):
        self.text += data
        if self.rows:
            self.rows[-1] += data


class Rows(unittest.TestCase):
    def test_no_files_are_a_table_of_none(self):
        self.assertEqual(rows_of([]), [])
        self.assertEqual(tally([]), "0 files")
        self.assertEqual(len(table([]).splitlines()), 1)

    def test_failed_ones_come_first_then_what_was_not_done(self):
        codes = (0, 130, 3, 1, 0, 5, 4)
        rows = rows_of(made(str(i), ExitCode(code)) for i, code in enumerate(codes))
        self.assertEqual([row.code for row in rows], [1, 5, 4, 130, 3, 0, 0])
        self.assertEqual(tally(rows), "7 files: 3 failed, 1 not done, 1 incomplete, 2 done")

    def test_many_pictures_show_their_worst(self):
        pictures = [{"picture": f"{i}.png", "cut": cut(10 * i, 1 / (i + 1))} for i in range(3)]
        (row,) = rows_of([made("a", pictures=pictures)])
        self.assertEqual((row.triangles, row.error_px, len(row.pictures)), (20, 1.0, 3))

    def test_the_table_has_a_line_for_each_with_the_cause(self):
        rows = rows_of(
            [
                made("fine", cut=cut(1234, 0.5), wall_s=61.0, memory={"peak_bytes": 3 << 30}),
                made("slow\n\x1b[2J", ExitCode.FAILED, cause="timeout"),
            ]
        )
        lines = table(rows).splitlines()
        self.assertEqual(len(lines), 3)
        self.assertRegex(lines[1], r"^timeout .* slow \ufffd\[2J\.blend$")
        self.assertRegex(lines[2], r"^done +1:01 +3\.2 GB +1,234 +0\.50 px +fine\.blend$")


class Page(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.target = self.folder / "night.html"

    def read(self, *reports, **values):
        self.text = html_page.page(
            rows_of(reports), "Lodestone: render", "today", self.target, **values
        )
        return Reader(self.text)

    def test_a_comparison_has_its_numbers_and_other_runs_no_columns_for_them(self):
        reports = (compared("a", 0.987), made("b", ExitCode.FAILED))
        text = self.read(*reports).text
        for words in ("Difference", "mean 2.55", "largest 255 of 255", "SSIM 0.9870", "most: Tree"):
            self.assertIn(words, text)
        self.assertIn("2.0 sof 12.5 s", text)
        head, failed, done = table(rows_of(reports)).splitlines()
        self.assertEqual(head.split()[-3:], ["mean", "SSIM", "file"])
        self.assertEqual(done.split()[-3:], ["2.55", "0.9870", "a.blend"])
        self.assertEqual(failed.split()[-1], "b.blend")
        self.assertNotIn("Difference", self.read(made("b")).text)
        self.assertNotIn("SSIM", table(rows_of([made("b")])))

    def test_a_hostile_name_in_a_comparison_is_text(self):
        plain = self.read(compared("a", 0.9)).tags
        for name in HOSTILE:
            self.assertEqual(self.read(compared("a", 0.9, name)).tags, plain)

    def test_an_empty_run_is_a_page(self):
        self.assertIn("0 files", self.read().text)

    def test_failed_first_with_message_and_numbers(self):
        picture = {"cut": cut(41300, 0.97), "picture": "/o/fine.png"}
        fine = made("fine", **picture, wall_s=5, memory={"peak_bytes": 5 << 20})
        broken = made("broken", ExitCode.UNREADABLE, cause="crash", message="Blender died")
        page = self.read(fine, broken)
        self.assertRegex(page.rows[1], "broken.*crash.*Blender died")
        self.assertRegex(page.rows[2], r"fine.*done.*0:05.*5\.2 MB.*41\.3 k.*0\.97 px.*Tree")
        self.assertIn('class="failed"', self.text)

    def test_no_name_is_more_than_text(self):
        plain = self.read(made("x", **self.everything("x")))
        for name in HOSTILE:
            page = self.read(made(name, **self.everything(name)))
            self.assertEqual(page.tags, plain.tags, name)
            self.assertEqual([k for k, _ in page.attributes], [k for k, _ in plain.attributes])
            self.assertIn(printable(name), page.text)
            self.assertNotIn("\x1b", page.text)
            self.assertNotIn("\u202e", page.text)
            html_page.write(str(self.target), self.text)
            self.assertTrue(self.target.read_text("utf-8"))

    def everything(self, name):
        return {
            "message": name,
            "cause": name,
            "cut": cut(1, 1.0, name),
            "picture": f"/o/{name}.png".replace("\x00", ""),
            "log": f"/o/{name}.log".replace("\x00", ""),
            "problems": [{"object": name, "severity": "error", "code": "x", "message": name}],
        }

    def test_links_are_relative_and_lead_to_the_file(self):
        for name in HOSTILE:
            name = name.replace("\ud800", "")  # not in any name of a file
            log = str(self.folder / "night.files" / (name.replace("/", "-") + ".log"))
            page = self.read(made("a", ExitCode.FAILED, log=log))
            (link,) = [value for key, value in page.attributes if key == "href"]
            self.assertTrue(link.startswith("./"), link)
            self.assertNotIn(":", link)
            self.assertEqual(
                unquote(link[2:], errors="surrogateescape"), log_name(log, self.folder)
            )

    def test_nothing_is_loaded_from_elsewhere(self):
        thumbnail = self.folder / "a.jpg"
        thumbnail.write_bytes(b"\xff\xd8 small picture")
        page = self.read(made("a", picture=str(self.folder / "a.png"), thumbnail=str(thumbnail)))
        self.assertNotIn("script", page.tags)
        self.assertNotIn("link", page.tags)
        (source,) = [value for key, value in page.attributes if key == "src"]
        self.assertTrue(source.startswith("data:image/jpeg;base64,/9g"))
        self.assertIn("default-src 'none'", dict(page.attributes)["content"] + self.text)

    def test_a_lost_thumbnail_leaves_the_link(self):
        page = self.read(made("a", picture="/o/a.png", thumbnail="/nowhere.jpg"))
        self.assertNotIn("img", page.tags)
        self.assertIn("href", [key for key, _ in page.attributes])

    def test_a_flood_of_problems_is_counted_not_shown(self):
        one = {"object": "Leaf", "severity": "warning", "code": "x", "message": "text"}
        page = self.read(made("a", problems=[one] * 10_000))
        self.assertIn("10000 problems", page.text)
        self.assertLess(len(self.text), 60_000)


def log_name(path, folder):
    return str(Path(path).relative_to(folder))


if __name__ == "__main__":
    unittest.main()
