# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards profiles: the command line wins over them, they win over the file, typos are refused."""

import contextlib
import io
import json
import tempfile
import unittest
from argparse import ArgumentParser
from pathlib import Path

import addon_path  # noqa: F401
from lodestone.core.batch import profile_file
from lodestone.core.batch.command_line import jobs, parse
from lodestone.core.batch.verbs import VERBS


class Profile(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name) / "profile.json"

    def options(self, value, *arguments, verb="render"):
        text = value if isinstance(value, str) else json.dumps(value)
        self.path.write_text(text)
        out = () if verb == "build" else ("--out", "o.png")
        return parse([verb, "a.blend", *out, "--profile", str(self.path), *arguments])

    def refused(self, value, *arguments):
        with contextlib.redirect_stderr(io.StringIO()) as said:
            with self.assertRaises(SystemExit) as caught:
                self.options(value, *arguments)
        self.assertEqual(caught.exception.code, 2)
        self.assertNotIn("Traceback", said.getvalue())
        return said.getvalue()

    def test_an_empty_profile_changes_nothing(self):
        plain = vars(parse(["render", "a.blend", "--out", "o.png"]))
        found = vars(self.options({}))
        self.assertEqual({**found, "profile": None}, plain)

    def test_without_both_the_file_decides(self):
        (job,) = jobs(self.options({}))
        picture = job.pictures[0]
        self.assertEqual((picture.pixel_error, picture.antialias, picture.size), (None, None, None))

    def test_every_kind_of_value(self):
        options = self.options(
            {
                "pixel_error": 2,
                "antialias": "off",
                "size": [64, 36],
                "frames": "1-3",
                "max_memory": "1G",
                "timeout": 2.5,
                "jobs": 3,
                "strict": True,
                "camera": "Far",
                "keep": "never",
            }
        )
        self.assertEqual((options.pixel_error, options.antialias), (2.0, "off"))
        self.assertEqual((options.size, options.frames), ((64, 36), (1, 3)))
        self.assertEqual((options.max_memory, options.timeout, options.jobs), (10**9, 2.5, 3))
        self.assertEqual((options.strict, options.camera, options.keep), (True, "Far", "never"))

    def test_the_command_line_wins(self):
        profile = {"pixel_error": 2, "strict": True, "keep": "never", "jobs": 4}
        options = self.options(profile, "--pixel-error=0", "--no-strict", "--keep", "failed")
        self.assertEqual((options.pixel_error, options.strict), (0.0, False))
        self.assertEqual((options.keep, options.jobs), ("failed", 4))

    def test_an_unknown_key_is_named(self):
        said = self.refused({"pixel_eror": 1})
        self.assertIn("'pixel_eror'", said)
        self.assertIn("pixel_error", said.split("known:")[1])

    def test_keys_of_other_verbs_serve_a_shared_profile(self):
        options = self.options({"pixel_error": 2, "threads": 1}, verb="build")
        self.assertEqual(options.threads, 1)
        self.assertFalse(hasattr(options, "pixel_error"))

    def test_what_belongs_to_one_run_is_refused(self):
        for key in ("out", "json", "log", "html", "resume", "profile", "files", "views"):
            self.assertIn("command line", self.refused({key: "x"}))

    def test_inputs_and_results_of_every_verb_belong_to_one_run(self):
        run = {"files", "help", "html", "json", "log", "profile", "resume"}
        for verb in VERBS:
            options = ArgumentParser()
            verb.add_options(options)
            of_one_run = {one.dest for one in options._actions if profile_file._of_one_run(one)}
            self.assertLessEqual(run, of_one_run, verb.name)
            self.assertEqual("out" in of_one_run, verb.asks_for_pictures, verb.name)
            for serves_many in ("store", "blender", "strict", "jobs", "pixel_error", "keep"):
                self.assertNotIn(serves_many, of_one_run, verb.name)

    def test_wrong_values_are_named_with_their_key(self):
        for key, value in (
            ("pixel_error", -1),
            ("pixel_error", "many"),
            ("pixel_error", True),
            ("pixel_error", None),
            ("size", [640]),
            ("size", {"w": 1}),
            ("strict", "yes"),
            ("strict", 1),
            ("antialias", "more"),
            ("camera", 5),
            ("jobs", 0),
            ("jobs", 1.5),
            ("max_memory", "lots"),
        ):
            self.assertIn(f"{key}", self.refused({key: value}).split("--profile")[-1], (key, value))

    def test_what_is_no_profile_is_refused(self):
        self.assertIn("object", self.refused([]))
        self.assertIn("--profile", self.refused("{"))
        self.assertIn("twice", self.refused('{"jobs": 1, "jobs": 2}'))
        self.assertIn("--profile", self.refused("\x00" * 100))


if __name__ == "__main__":
    unittest.main()
