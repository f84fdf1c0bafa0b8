# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards batch.py's verbs: what each refuses before work is done, and what it says it made."""

import importlib
import os
import pkgutil
import tempfile
import unittest
from argparse import ArgumentParser
from pathlib import Path

import addon_path
from lodestone.core.batch.command_line import jobs, parser
from lodestone.core.batch.file_jobs import PictureRequest
from lodestone.core.batch import verbs
from lodestone.core.batch.picture_making import MAKERS
from lodestone.core.batch.verbs import VERBS, verb_of
from lodestone.core.batch.verbs.verb import Verb
from lodestone.core.exit_codes import ExitCode, Failed


class Verbs(unittest.TestCase):
    def test_each_is_found_by_its_name_and_makes_jobs_of_that_name(self):
        for verb in VERBS:
            with self.subTest(verb.name):
                self.assertIs(verb_of(verb.name), verb)
                more = ["--out", "a.png"] if verb.asks_for_pictures else []
                (job,) = jobs(parser().parse_args([verb.name, "a.blend", *more]))
                self.assertEqual(job.verb, verb.name)
                self.assertEqual(len(job.pictures), len(more) // 2)

    def test_each_class_with_a_name_is_in_the_list(self):
        def below(kind):
            return {kind, *(one for child in kind.__subclasses__() for one in below(child))}

        for module in pkgutil.iter_modules(verbs.__path__):
            importlib.import_module(f"{verbs.__name__}.{module.name}")
        named = {kind for kind in below(Verb) if "name" in vars(kind)}
        self.assertEqual({type(verb) for verb in VERBS}, named)

    def test_only_build_builds_what_no_picture_asks_for(self):
        originals = [PictureRequest("a.png", pixel_error=0.0)]
        levels = [*originals, PictureRequest("b.png", pixel_error=1.0)]
        for verb in VERBS:
            with self.subTest(verb.name):
                self.assertEqual(verb.builds_levels(originals), verb.name == "build")
                self.assertTrue(verb.builds_levels(levels))

    def test_compare_refuses_originals(self):
        verb_of("compare").check_requests([PictureRequest("a.png", pixel_error=1.0)])
        originals = [PictureRequest("a.png", pixel_error=0.0)]
        for verb in VERBS:
            if verb.name != "compare":
                verb.check_requests(originals)
        with self.assertRaises(Failed) as caught:
            verb_of("compare").check_requests(originals)
        self.assertEqual(caught.exception.code, ExitCode.FAILED)
        self.assertIn("Pixel Error 0", str(caught.exception))

    def test_results_are_what_the_report_names(self):
        two = {"pictures": [{"picture": "a.png"}, {"skipped": True}, {"picture": "b.png"}]}
        self.assertEqual(verb_of("render").results(two), ["a.png", "b.png"])
        self.assertEqual(verb_of("compare").results({"picture": "a.png"}), ["a.png"])
        self.assertEqual(verb_of("export").results({"scene": "a/scene.pov"}), ["a/scene.pov"])
        self.assertEqual(verb_of("build").results({"store": "levels"}), ["levels/tileset.json"])
        for verb in VERBS:
            self.assertEqual(verb.results({}), [])

    def test_pictures_and_scenes_are_printed_and_stores_are_not(self):
        self.assertEqual(verb_of("render").lines({"picture": "a.png"}), ["a.png"])
        self.assertEqual(verb_of("export").lines({"scene": "a/scene.pov"}), ["a/scene.pov"])
        self.assertEqual(verb_of("build").lines({"store": "levels"}), [])

    def test_each_that_asks_for_pictures_has_one_who_makes_them(self):
        self.assertEqual(set(MAKERS), {verb.name for verb in VERBS if verb.asks_for_pictures})


class Pages(unittest.TestCase):
    def test_the_page_names_each_verb_and_each_option(self):
        page = (addon_path.ROOT / "blender_addon" / "docs" / "batch.md").read_text()
        for verb in VERBS:
            self.assertIn(f"`{verb.name}`", page)
            options = ArgumentParser(add_help=False)
            verb.add_options(options)
            for action in options._actions:
                for name in action.option_strings[:1]:  # the others are --no-...
                    self.assertRegex(page, rf"{name}(?![\w-])", verb.name)


class Outputs(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def refused(self, verb, out):
        with self.assertRaises(Failed) as caught:
            verb_of(verb).check_output(str(out))
        return str(caught.exception)

    def test_folders_are_made_before_any_work(self):
        verb_of("render").check_output(str(self.folder / "pictures" / "a.png"))
        verb_of("export").check_output(str(self.folder / "scenes" / "a"))
        self.assertEqual(sorted(os.listdir(self.folder)), ["pictures", "scenes"])
        self.assertEqual(os.listdir(self.folder / "pictures"), [])
        self.assertTrue((self.folder / "scenes" / "a").is_dir())

    def test_a_folder_is_no_picture(self):
        for verb in ("render", "compare"):
            self.assertIn("is a folder", self.refused(verb, self.folder))
        verb_of("export").check_output(str(self.folder))

    def test_what_cannot_be_written_is_named(self):
        (self.folder / "file").write_text("")
        self.assertIn("cannot make", self.refused("export", self.folder / "file" / "scene"))
        self.assertIn("cannot make", self.refused("render", self.folder / "file" / "a.png"))


if __name__ == "__main__":
    unittest.main()
