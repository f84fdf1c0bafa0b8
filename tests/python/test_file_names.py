# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards names made of the names of others: inside their folder, apart, and not too long."""

import json
import os
import sys
import tempfile
import unittest
from pathlib import Path

import addon_path  # noqa: F401
from lodestone.core import run_report
from lodestone.core.batch import views_file
from lodestone.core.batch.command_line import jobs, parser
from lodestone.core.batch.file_jobs import PictureRequest
from lodestone.core.file_names import fitting, folder_name
from lodestone.core.printable_text import printable, sentence, valid
from lodestone.core.problems import WARNING, Problems
from lodestone.core.store import store_path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "blender"))
import hostile_names as hostile  # noqa: E402


def every_file():
    """Of the corpus, as the file system gives them to Python."""
    stems = hostile.file_stems(".blend") + [".", "..", "...", "a", "a.log", "a.scene"]
    stems += [os.fsdecode(name) for name in hostile.BYTES]
    return [stem + ".blend" for stem in stems]


def parse(*arguments):
    return jobs(parser().parse_args(arguments))


class FileNames(unittest.TestCase):
    def one_step(self, name):
        """A name of something in a folder."""
        self.assertNotIn(name, ("", ".", ".."))
        self.assertNotIn("/", name)
        self.assertLessEqual(len(os.fsencode(name)), 255)

    def test_what_fits_is_kept_and_what_does_not_is_told_apart(self):
        self.assertEqual(fitting("village", 7), "village")
        long, other = (fitting("é" * 200 + end, 255) for end in "ab")
        self.assertLessEqual(len(long.encode()), 255)
        self.assertNotEqual(long, other)
        self.assertTrue(long.startswith("é" * 100))
        self.assertEqual(len(fitting(os.fsdecode(b"\xff" * 300), 255)), 17)  # a hash alone

    def test_every_file_has_a_folder_of_its_own_below_the_one_around_it(self):
        files = sorted(set(every_file()))
        names = [folder_name(f"/scenes/{file}") for file in files]
        self.assertEqual(len(set(names)), len(files))
        for name in names:
            self.one_step(name)
            self.one_step(name + ".scene")
        plain = [folder_name(f"{name}.blend") for name in ("village", "v.2", "...", " ")]
        self.assertEqual(plain, ["village", "v.2", "...", " "])

    def test_no_store_lies_outside_of_its_folder_or_in_anothers(self):
        with tempfile.TemporaryDirectory() as folder:
            taken = {}
            for file in sorted(set(every_file())):
                store = store_path.store_folder(f"{folder}/{file}")
                self.assertEqual(store.resolve().parent, Path(folder).resolve() / "lodestone")
                scene = store_path.scene_folder(store)
                for path in (store, scene, store.with_name(store.name + ".log")):
                    self.assertIsNone(taken.get(path), file)
                    taken[path] = file
            self.assertEqual(len(taken), 3 * len(set(every_file())))

    def test_a_store_in_the_cache_has_a_name_that_fits(self):
        for file in every_file():
            store = store_path.store_folder(
                f"/dev/null/{file}", environment={"LODESTONE_CACHE": "/cache"}
            )
            self.assertEqual(store.parent, Path("/cache"))
            self.one_step(store.name + ".scene")

    def test_results_of_several_files_stay_in_their_folders(self):
        files = every_file()
        for options in (["render", "--out", "/out"], ["export", "--out", "/out"], ["build"]):
            for job in parse(*options, "--store", "/stores", "--", *sorted(set(files))):
                self.assertEqual(Path(os.path.abspath(job.store)).parent, Path("/stores"))
                for picture in job.pictures:
                    self.assertEqual(Path(os.path.abspath(picture.out)).parent, Path("/out"))
                    self.one_step(Path(picture.out).name)

    def test_frames_of_a_long_name_are_told_apart(self):
        picture = PictureRequest(out=f"/out/{'a' * 251}.png")
        names = {Path(picture.for_frame(frame).out).name for frame in (1, 2, 10_000)}
        self.assertEqual(len(names), 3)
        for name in names:
            self.one_step(name)
            self.assertTrue(name.endswith(".png"))

    def test_temporary_pictures_are_known_by_their_owner(self):
        for ending in (".png", ".exr"):
            self.assertEqual(
                run_report.temporary_owner(run_report.temporary_name(ending)), os.getpid()
            )
        self.assertEqual(run_report.temporary_owner(".lodestone-1.png.exr"), 0)

    def test_views_that_nothing_can_be_called_are_refused(self):
        options = parser().parse_args(["render", "a.blend", "--out", "a.png"])
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "views.json"
            for entry in (
                r'{"out": "a\u0000.png"}',
                r'{"out": "\ud800.png"}',
                r'{"out": "a.png", "camera": "\ud800"}',
                r'{"out": "a.png", "camera": "a\u0000b"}',
                r'{"out": "a.png", "camera": 3}',
            ):
                path.write_text(f"[{entry}]")
                with self.assertRaisesRegex(ValueError, "entry 0"):
                    views_file.read_views(str(path), options)


class Text(unittest.TestCase):
    def test_a_path_that_is_no_text_can_be_reported_and_read_again(self):
        path = os.fsdecode(b"/scenes/caf\xe9.blend")
        with tempfile.TemporaryDirectory() as folder:
            run_report.write(f"{folder}/report.json", {"input": path, "name": "名"})
            text = Path(folder, "report.json").read_text("utf-8")
            self.assertIn("名", text)
            self.assertEqual(json.loads(text)["input"], path)

    def test_what_is_shown_is_one_line_that_steers_nothing(self):
        for name in [*hostile.names(), "\udcff\ud800"]:
            shown = printable(name)
            self.assertEqual(len(shown.splitlines()), 1 if shown else 0, ascii(name))
            shown.encode()
            self.assertFalse(set(shown) & set("\x1b\x07\x7f\u202e\u2066\u2028\x85"), ascii(name))

    def test_messages_hold_nothing_that_blender_cannot_show(self):
        problems = Problems()
        problems.add("Oak", WARNING, "x", 'Library "Oak" is missing (/caf\udce9/\ud800)')
        (problem,) = problems
        self.assertEqual(problem.message, 'Library "Oak" is missing (/caf\ufffd/\ufffd)')
        self.assertEqual(valid("名 🐸"), "名 🐸")

    def test_a_name_of_any_bytes_is_told(self):
        for name in hostile.BYTES:
            with self.assertRaises(UnicodeDecodeError) as caught:
                name.decode()
            self.assertIn("rename", sentence(caught.exception))
        self.assertIn("caf\\xe9", sentence(UnicodeDecodeError("utf-8", b"caf\xe9", 3, 4, "")))


if __name__ == "__main__":
    unittest.main()
