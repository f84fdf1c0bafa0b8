# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the pages: no measured figure is typed, a README is one screen, links and names of files
are of something that is there."""

import json
import re
import unittest

import pages
from repository import ROOT, files, files_ending, text_of

RESULTS = re.compile(r"(\w+)/docs/results/(\w+)\.md")


class TheCheckOfFigures(unittest.TestCase):
    def test_measured_figures_are_found(self):
        for line in (
            "Building takes 40 CPU s.",
            "it is 3.21 CPU ms a shape",
            "a step of 10 m (.18 ms) takes",
            "each takes 2.4 microseconds",
            "saves 41.4 MB of memory",
            "3.4 kB for the mesh",
            "an SSIM of .934",
            "SSIM far 0.946",
            "`SSIM` is 1.00 there",
            "meshes are 1.8 times too bright",
            "takes .86 times the memory",
            "takes 17 % less time",
            "at most 3.5 % off",
            "within 3/255 up to 50 degrees",
            "values differ by 13 of 255",
        ):
            self.assertEqual(pages.measured_figures(f"a\n\n{line}\n"), [line], line)

    def test_what_is_decided_or_counted_is_none(self):
        for line in (
            "at most 8 million triangles, 16 times the rays",
            "limits of 64 KiB to 4 MiB; `--budget 50M`, `--max-memory 8G`, `2GiB`",
            "each factor within 1/64 ... 64",
            "the 99.9 % quantile, blue (2 %) and green (5 %)",
            "rays that add less than so many of 255 steps",
            "mean, maximum and SSIM over the covered pixels (640 x 360)",
            "| Textures | 0 px | 2 px |",
            "equations 4.16-4.18, Figure 5.10, Blender 3.4.1",
            "it is kept about every 20 seconds; under 2 minutes",
            "`--area-samples 17`, 2.3 GHz, CPU time, an ms file",
        ):
            self.assertEqual(pages.measured_figures(f"a\n\n{line}\n"), [], line)

    def test_columns_of_measures_are_found_whatever_their_cells_look_like(self):
        table = "| scene | triangles | parse, CPU s |\n|---|---|---|\n| a | 5 | {} |\n"
        for cell in ("4.03", "**0.4**", ".7 / .8", "10"):
            found = pages.measured_figures(table.format(cell))
            self.assertEqual(found, [f"| a | 5 | {cell} |"], cell)
        self.assertEqual(pages.measured_figures(table.format("less")), [])
        self.assertEqual(pages.measured_figures(table.replace("CPU s", "parts").format("10")), [])

    def test_what_programs_write_and_code_are_left_out(self):
        page = "<!-- strip:begin -->\n9 MB\n<!-- strip:end -->\n"
        self.assertEqual(pages.measured_figures(page), [])
        self.assertEqual(pages.measured_figures(page + "9 MB\n"), ["9 MB"])
        self.assertEqual(pages.measured_figures(page.replace("strip:end", "strap:end")), ["9 MB"])
        self.assertEqual(pages.measured_figures("```\nsleep 9 ms\n```\n"), [])

    def test_results_the_notebook_and_changes_may_hold_figures(self):
        for name in ("backend/docs/results/cut.md", "backend/docs/EXPERIMENTS.md", "CHANGELOG.md"):
            self.assertTrue(pages.MAY_HOLD_FIGURES.fullmatch(name), name)
        for name in ("README.md", "backend/docs/results.md", "backend/docs/choosing.md"):
            self.assertFalse(pages.MAY_HOLD_FIGURES.fullmatch(name), name)


class TheCheckOfLinksAndNames(unittest.TestCase):
    KNOWN = pages.with_folders(
        ["a/README.md", "a/b.png", "backend/src/choose/cut.cpp", "tests/bench/speed/bench_cut.cpp"]
        + ["blender_addon/lodestone/core/store/store_path.py"]
    )

    def links(self, text: str) -> list[str]:
        return pages.broken_links("a/README.md", {"a/README.md": text}, self.KNOWN)

    def test_links_to_what_is_there_are_right(self):
        text = "# The one: `x`\n![p](b.png) [c](../tests/bench) [d](../a/README.md#the-one-x)\n"
        self.assertEqual(self.links(text + "[e](#the-one-x) [f](https://example.org/x)\n"), [])
        self.assertEqual(self.links("```\n[g](gone.md)\n```\n[[1] of it](b.png)\n"), [])

    def test_links_to_what_is_not_there_are_found(self):
        for target in ("c.png", "../a/c.md", "#two", "b.png#one", "../../a/b.png", "/a/b.png2"):
            self.assertEqual(self.links(f"# One\n\n![p]({target})\n"), [target], target)

    def test_names_of_files_that_are_there_are_right(self):
        for text in (
            "`choose/cut`, `choose`, `bench_cut.cpp` and `choose/cut.cpp`",
            "`core/store/`, `core/store/store_path.py` and `store_path.py`",
            "    build/release/x tests/bench/speed/bench_cut.cpp --rounds 5",
            "`backend/src/choose/cut` in `backend/src/choose/`",
            "`tests/backend/ROOM/test_FILE.cpp`, `tests/bench/bench_...`, $X/tests/mine.py",
            "`scene.pov`, `choose.total()`, cut_gone.cpp without quotes",
        ):
            self.assertEqual(pages.missing_files(text, self.KNOWN), [], text)

    def test_names_of_files_that_are_not_there_are_found(self):
        for text, missing in (
            ("`choose/budget`", "choose/budget"),
            ("see `test_gone.cpp`", "test_gone.cpp"),
            ("`core/shop/`", "blender_addon/lodestone/core/shop"),
            ("    python3 tests/bench/gone.py --x", "tests/bench/gone.py"),
            ("backend/src/quality/cut.h tells", "backend/src/quality/cut.h"),
        ):
            self.assertEqual(pages.missing_files(text, self.KNOWN), [missing], text)

    def test_a_long_readme_is_found(self):
        text = "x\n" * (pages.LONGEST_README + 1)
        self.assertTrue(pages.is_too_long("a/README.md", text))
        self.assertFalse(pages.is_too_long("a/README.md", text[2:]))
        self.assertFalse(pages.is_too_long("a/docs/choosing.md", text))


class TheRepository(unittest.TestCase):
    maxDiff = None

    @classmethod
    def setUpClass(cls):
        cls.pages = {name: text_of(name) for name in files_ending(".md")}
        cls.known = pages.with_folders(files())

    def broken(self, check) -> dict[str, list[str]]:
        found = {name: check(name, text) for name, text in self.pages.items()}
        return {name: wrong for name, wrong in found.items() if wrong}

    def test_every_room_has_a_page(self):
        for room in ("", "backend/", "povray_export/", "blender_addon/", "samples/", "tests/"):
            self.assertIn(f"{room}README.md", self.pages)

    def test_no_page_holds_a_measured_figure(self):
        def figures(name, text):
            return [] if pages.MAY_HOLD_FIGURES.fullmatch(name) else pages.measured_figures(text)

        self.assertEqual(self.broken(figures), {})

    def test_a_readme_is_one_screen(self):
        self.assertEqual([n for n, text in self.pages.items() if pages.is_too_long(n, text)], [])

    def test_links_lead_somewhere(self):
        self.assertEqual(
            self.broken(lambda name, _: pages.broken_links(name, self.pages, self.known)), {}
        )

    def test_files_that_pages_name_are_there(self):
        def missing(name, text):
            if pages.TELL_OF_OTHER_DAYS.fullmatch(name):
                return []
            return pages.missing_files(text, self.known)

        self.assertEqual(self.broken(missing), {})

    def test_every_page_of_results_has_its_json_and_is_listed(self):
        seen = 0
        for name in self.pages:
            told = RESULTS.fullmatch(name)
            if told and told[2] != "README":
                seen += 1
                data = json.loads(text_of(name.removesuffix(".md") + ".json"))
                self.assertEqual(f"# {data['title']}", self.pages[name].split("\n")[0], name)
                listed = self.pages[f"{told[1]}/docs/results/README.md"]
                self.assertIn(f"]({told[2]}.md)", listed, name)
        self.assertGreater(seen, 20)

    def test_the_program_that_a_page_shows_is_the_sample(self):
        shown = self.pages["backend/docs/from-c.md"].partition("```c\n")[2].partition("```")[0]
        self.assertEqual(shown, text_of("samples/minimal.c"))

    def test_pictures_are_shown_by_a_page(self):
        shown = set()
        for name, text in self.pages.items():
            for target in pages.LINK.findall(text):
                shown.add(pages.normal(f"{name.rpartition('/')[0]}/{target}"))
        pictures = [n for n in files() if re.fullmatch(r"\w+/docs/.*\.(png|svg|jpg)", n)]
        self.assertGreater(len(pictures), 20)
        self.assertEqual([name for name in pictures if name not in shown], [], ROOT)


if __name__ == "__main__":
    unittest.main()
