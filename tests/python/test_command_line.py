# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards batch.py's command line: what is asked for is what Blender is told, or exit 2."""

import contextlib
import io
import json
import os
import subprocess
import sys
import tempfile
import unittest
from dataclasses import fields
from pathlib import Path

import addon_path  # noqa: F401
from lodestone.core.batch import views_file
from lodestone.core.batch.command_line import jobs, parser
from lodestone.core.batch.command_line import parse as parse_options
from lodestone.core.batch.file_jobs import FileJob, PictureRequest


def parse(*arguments):
    return jobs(parser().parse_args(arguments))


class Start(unittest.TestCase):
    def test_reading_a_command_loads_no_more_of_the_library_than_its_constants(self):
        """Of a picture that takes a second, loading the rest took a tenth."""
        told = subprocess.run(
            [
                sys.executable,
                "-c",
                "import lodestone.core.batch.file_task, sys; print(*sys.modules)",
            ],
            env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
            capture_output=True,
            text=True,
            check=True,
        ).stdout.split()
        loaded = {name for name in told if "lodestone_native." in name}
        self.assertLessEqual({name.rpartition(".")[2] for name in loaded}, {"enums"})


class Usage(unittest.TestCase):
    def refused(self, *arguments):
        with contextlib.redirect_stderr(io.StringIO()) as said:
            with self.assertRaises((SystemExit, ValueError)) as caught:
                parse(*arguments)
        if isinstance(caught.exception, SystemExit):
            self.assertEqual(caught.exception.code, 2)
        return said.getvalue() + str(caught.exception)

    def test_nothing_is_refused(self):
        self.refused()
        self.refused("render")

    def test_a_render_needs_somewhere_to_go(self):
        self.assertIn("--out", self.refused("render", "a.blend"))

    def test_a_comparison_is_a_picture_of_levels(self):
        (job,) = parse("compare", "a.blend", "--out", "a.png", "--pixel-error", "2", "--keep=never")
        self.assertEqual((job.verb, job.keep, len(job.pictures)), ("compare", "never", 1))
        self.assertTrue(job.pictures[0].out.endswith("/a.png"))
        one, other = parse("compare", "a.blend", "b.blend", "--out", "folder")
        self.assertTrue(other.pictures[0].out.endswith("/folder/b.png"))
        self.assertIn(".png", self.refused("compare", "a.blend", "--out", "a.jpg"))
        self.refused("compare", "a.blend", "--out", "a.png", "--false-color")

    def test_a_picture_is_a_png(self):
        self.assertIn(".png", self.refused("render", "a.blend", "--out", "a.jpg"))

    def test_overrides_and_a_budget_travel_to_blender(self):
        own = ("--shadows=0.5", "--trace-depth=9", "--indirect=0", "--bounces=2", "--budget=50M")
        (job,) = parse("render", "a.blend", "--out", "a.png", "--antialias=automatic", *own)
        (picture,) = FileJob.load(job.dump()).pictures
        overrides = {"shadows": 0.5, "trace_depth": 9, "indirect": 0, "bounces": 2}
        self.assertEqual(picture.overrides, overrides)
        self.assertEqual((picture.budget, picture.antialias), (50_000_000, "automatic"))
        (plain,) = parse("render", "a.blend", "--out", "a.png")
        self.assertEqual((plain.pictures[0].overrides, plain.pictures[0].budget), ({}, None))

    def test_a_view_has_overrides_of_its_own(self):
        with tempfile.TemporaryDirectory() as folder:
            views = Path(folder) / "views.json"
            entries = [{"out": "a.png"}, {"out": "b.png", "shadows": 4, "budget": "1G"}]
            views.write_text(json.dumps(entries))
            (job,) = parse("render", "a.blend", f"--views={views}", "--shadows=2", "--lights=3")
        found = [(picture.overrides, picture.budget) for picture in job.pictures]
        self.assertEqual(found[0], ({"shadows": 2.0, "lights": 3.0}, None))
        self.assertEqual(found[1], ({"shadows": 4.0, "lights": 3.0}, 1_000_000_000))

    def test_bad_numbers_are_named(self):
        for option, value in (
            ("--pixel-error", "-1"),
            ("--pixel-error", "nan"),
            ("--pixel-error", "inf"),
            ("--threads", "x"),
            ("--size", "640"),
            ("--size", "0x5"),
            ("--size", "99999999x1"),
            ("--frames", "5-1"),
            ("--frames", "a-b"),
            ("--timeout", "0"),
            ("--jobs", "0"),
            ("--max-memory", "8X"),
            ("--max-memory", "0"),
            ("--max-memory", "-1G"),
            ("--budget", "0"),
            ("--shadows", "-1"),
            ("--textures", "nan"),
            ("--trace-depth", "1.5"),
            ("--trace-depth", "0"),
            ("--area-samples", "1000"),
            ("--indirect", "many"),
            ("--bounces", "9"),
        ):
            said = self.refused("render", "a.blend", "--out", "a.png", f"{option}={value}")
            self.assertIn(option, said)

    def test_two_files_of_one_name_would_overwrite_each_other(self):
        self.assertIn("two files", self.refused("render", "x/a.blend", "y/a.blend", "--out", "o"))
        parse("build", "x/a.blend", "y/a.blend")
        self.refused("build", "x/a.blend", "y/a.blend", "--store", "s")

    def test_one_file_named_twice_is_not_called_two_files(self):
        for verb in (("render", "--out", "o"), ("build",)):
            self.assertIn("twice", self.refused(verb[0], "x/a.blend", "x/a.blend", *verb[1:]))

    def test_resuming_needs_the_log_to_go_on_with(self):
        with contextlib.redirect_stderr(io.StringIO()) as said, self.assertRaises(SystemExit):
            parse_options(["build", "a.blend", "--resume"])
        self.assertIn("--log", said.getvalue())

    def test_memory_is_told_as_people_write_it(self):
        for text, expected in (
            ("8G", 8_000_000_000),
            ("500M", 500_000_000),
            ("1.5gb", 1_500_000_000),
            ("2 GiB", 2 << 30),
            ("1048576", 1 << 20),
        ):
            options = parser().parse_args(["build", "a.blend", "--max-memory", text])
            self.assertEqual(options.max_memory, expected, text)


class Jobs(unittest.TestCase):
    def test_one_picture_goes_to_its_file(self):
        (job,) = parse("render", "a.blend", "--out", "o/p.png", "--pixel-error", "0.5")
        self.assertEqual(job.pictures[0].out, os.path.abspath("o/p.png"))
        self.assertEqual(job.pictures[0].pixel_error, 0.5)
        self.assertEqual(job.file, os.path.abspath("a.blend"))

    def test_several_files_go_into_a_folder_and_have_stores_of_their_own(self):
        found = parse("render", "a.blend", "b.blend", "--out", "o", "--store", "s")
        self.assertEqual(
            [job.pictures[0].out for job in found],
            [os.path.abspath("o/a.png"), os.path.abspath("o/b.png")],
        )
        self.assertEqual([Path(job.store).name for job in found], ["a", "b"])

    def test_frames_are_numbered(self):
        (job,) = parse("render", "a.blend", "--out", "o", "--frames", "1-3")
        self.assertEqual(job.frames, (1, 3))
        self.assertEqual(Path(job.pictures[0].for_frame(2).out).name, "a_0002.png")

    def test_negative_frames_are_frames(self):
        (job,) = parse("render", "a.blend", "--out", "o", "--frames=-3--1")
        self.assertEqual(job.frames, (-3, -1))

    def test_an_export_goes_to_its_folder(self):
        (job,) = parse("export", "a.blend", "--out", "scene")
        self.assertEqual(job.pictures[0].out, os.path.abspath("scene"))

    def test_a_job_survives_the_way_to_blender(self):
        for job in parse(
            "render", 'q"uote\n{名}.blend', "--out", "o.png", "--size", "64x36", "--camera", "名"
        ):
            self.assertEqual(FileJob.load(job.dump()), job)

    def test_the_key_is_of_what_is_made_and_not_of_how_the_run_goes(self):
        (job,) = parse("render", "a.blend", "--out", "o.png")
        same = ("--threads=3", "--timeout=9", "--jobs=2", "--keep=always", "--max-memory=1G")
        for option in same:
            (other,) = parse("render", "a.blend", "--out", "o.png", option)
            self.assertEqual(other.key(), job.key(), option)
        for option in (
            "--pixel-error=2",
            "--camera=B",
            "--size=1x1",
            "--trust-scripts",
            "--strict",
        ):
            (other,) = parse("render", "a.blend", "--out", "o.png", option)
            self.assertNotEqual(other.key(), job.key(), option)

    def test_the_same_frame_of_a_longer_range_has_the_same_key(self):
        (short,) = parse("render", "a.blend", "--out", "o", "--frames=1-2")
        (long,) = parse("render", "a.blend", "--out", "o", "--frames=1-9")
        keys = [job.picture_key(*next(job.wanted())) for job in (short, long)]
        self.assertEqual(keys[0], keys[1])
        self.assertNotEqual(short.key(), long.key())


class Views(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name) / "views.json"

    def read(self, value, *options):
        self.path.write_text(json.dumps(value))
        return parse("render", "a.blend", "--views", str(self.path), *options)[0].pictures

    def test_an_entry_can_say_whatever_a_picture_has_of_its_own(self):
        controls = {control.key for control in views_file.NUMBERS}  # a picture's `overrides`
        own = {one.name for one in fields(PictureRequest)} - {"overrides"}
        self.assertEqual(set(views_file.VIEW_KEYS) - controls, own)

    def test_entries_fill_up_from_the_command_line(self):
        pictures = self.read(
            [{"out": "a.png"}, {"out": "b.png", "pixel_error": 0, "size": [64, 36]}],
            "--camera=Far",
            "--size=640x360",
        )
        self.assertEqual([p.camera for p in pictures], ["Far", "Far"])
        self.assertEqual([p.pixel_error for p in pictures], [None, 0.0])  # None: as the file has it
        self.assertEqual([p.size for p in pictures], [(640, 360), (64, 36)])

    def test_of_several_files_each_has_a_folder_of_its_own(self):
        self.path.write_text(json.dumps([{"out": "x/one.png"}, {"out": "two.png"}]))
        views = ("--views", str(self.path))
        found = parse("render", "a.blend", "b.blend", *views, "--out", "/pictures")
        self.assertEqual(
            [[picture.out for picture in job.pictures] for job in found],
            [
                ["/pictures/a/one.png", "/pictures/a/two.png"],
                ["/pictures/b/one.png", "/pictures/b/two.png"],
            ],
        )
        with self.assertRaisesRegex(ValueError, "--out"):
            parse("render", "a.blend", "b.blend", *views)
        self.path.write_text(json.dumps([{"out": "x/one.png"}, {"out": "y/one.png"}]))
        with self.assertRaisesRegex(ValueError, "same name"):
            parse("render", "a.blend", "b.blend", *views, "--out", "/pictures")

    def test_mistakes_are_named_with_their_entry(self):
        for value, word in (
            ({}, "list"),
            ([], "list"),
            ([1], "entry 0"),
            ([{"out": "a.png"}, {}], "entry 1"),
            ([{"out": "a.png", "colour": 1}], "colour"),
            ([{"out": "a.png", "antialias": "more"}], "antialias"),
            ([{"out": "a.png", "size": "big"}], "size"),
            ([{"out": "a.png", "pixel_error": "x"}], "number"),
            ([{"out": "a.png"}, {"out": "a.png"}], "same out"),
        ):
            with self.assertRaises(ValueError) as caught:
                self.read(value)
            self.assertIn(word, str(caught.exception))


if __name__ == "__main__":
    unittest.main()
