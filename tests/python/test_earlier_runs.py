# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards resuming: only what is done, unchanged and still there is not done again."""

import json
import os
import tempfile
import unittest
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path

import addon_path  # noqa: F401
from lodestone.core.batch import earlier_runs, input_stamps, run_log
from lodestone.core.batch.command_line import jobs, parser
from lodestone.core.batch.earlier_runs import Earlier
from lodestone.core.batch.file_jobs import BESIDE_PICTURES, OF_A_RUN, FileJob


class Resume(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.blend, self.image = self.folder / "a.blend", self.folder / "bark.png"
        self.blend.write_bytes(b"BLENDER-v304 and so on")
        self.image.write_bytes(b"bark")
        self.log = str(self.folder / "log.jsonl")
        self.job = self.job_of()
        self.out = Path(self.job.pictures[0].out)
        self.out.write_bytes(b"picture")

    def job_of(self, *options):
        arguments = ["render", str(self.blend), "--out", str(self.folder / "o.png"), *options]
        return jobs(parser().parse_args(arguments))[0]

    def note(self, job=None, exit_code=0, inputs=None):
        """What a run that came to its end leaves in the log."""
        job = job or self.job
        inputs = inputs or input_stamps.read(job.file, [str(self.image)])
        name = input_stamps.identity(inputs)
        log = run_log.BatchLog(self.log)
        log.add("inputs", id=name, file=job.file, inputs=inputs)
        report = {"exit_code": exit_code, "input": job.file, "picture": str(self.out)}
        outputs = earlier_runs.outputs([str(self.out)])
        log.add("file", file=job.file, key=job.key(), inputs=name, outputs=outputs, report=report)
        log.close()

    def found(self, job=None):
        return Earlier(run_log.read(self.log)).find(job or self.job)

    def test_nothing_is_known_without_a_log(self):
        self.assertIsNone(self.found().report)
        Path(self.log).write_text("")
        self.assertIsNone(self.found().report)

    def test_what_is_done_is_not_done_again(self):
        for code in (0, 3):
            self.note(exit_code=code)
            self.assertEqual(self.found().report["exit_code"], code)

    def test_what_failed_is_done_again(self):
        self.note()
        for code in (1, 4, 5, 130):
            self.note(exit_code=code)
            self.assertIsNone(self.found().report)

    def test_a_touched_file_is_not_a_changed_one(self):
        self.note()
        os.utime(self.blend, (1, 1))
        self.assertIsNotNone(self.found().report)

    def test_a_changed_file_is_done_again(self):
        self.note()
        self.blend.write_bytes(b"BLENDER-v304 and so OK")
        self.assertIsNone(self.found().report)

    def test_a_changed_or_missing_image_is_a_reason(self):
        self.note()
        os.utime(self.image, (1, 1))
        self.assertIsNone(self.found().report)
        self.note()
        self.assertIsNotNone(self.found().report)
        self.image.unlink()
        self.assertIsNone(self.found().report)

    def test_a_library_that_was_missing_and_has_come_is_a_reason(self):
        self.image.unlink()
        self.note(exit_code=3)
        self.assertIsNotNone(self.found().report)
        self.image.write_bytes(b"here")
        self.assertIsNone(self.found().report)

    def test_tiles_are_looked_at_one_by_one(self):
        for number in (1001, 1002):
            (self.folder / f"wall.{number}.png").write_bytes(b"tile")
        path = str(self.folder / "wall.<UDIM>.png")
        before = input_stamps.stamp(path)
        self.assertEqual(before[0], 8)
        (self.folder / "wall.1002.png").write_bytes(b"longer tile")
        self.assertNotEqual(input_stamps.stamp(path), before)

    def test_other_settings_are_another_job(self):
        self.note()
        self.assertIsNone(self.found(self.job_of("--pixel-error=2")).report)
        self.assertIsNotNone(self.found(self.job_of("--threads=2")).report)

    def test_another_lodestone_is_a_reason(self):
        self.note(replace(self.job, version="0.0.9"))
        self.assertIsNone(self.found(replace(self.job, version="0.1.0")).report)
        self.assertIsNotNone(self.found(replace(self.job, version="0.0.9")).report)

    def test_a_missing_or_replaced_picture_is_made_again(self):
        self.note()
        self.out.write_bytes(b"somebody else's")
        self.assertIsNone(self.found().report)
        self.note()
        self.out.unlink()
        self.assertIsNone(self.found().report)

    def test_a_killed_animation_goes_on_where_it_was(self):
        self.out.unlink()
        self.out.mkdir()
        job = self.job_of("--frames=1-3")
        inputs = input_stamps.read(job.file, [])
        name = input_stamps.identity(inputs)
        log = run_log.BatchLog(self.log)
        log.add("inputs", id=name, file=job.file, inputs=inputs)
        wanted = list(job.wanted())
        for frame, picture in wanted[:2]:
            Path(picture.out).write_bytes(b"frame")
            log.add(
                "picture",
                file=job.file,
                key=job.picture_key(frame, picture),
                inputs=name,
                out=picture.out,
                outputs=earlier_runs.outputs([picture.out]),
                made={"picture": picture.out, "number": frame},
            )
        log.close()
        found = self.found(job)
        self.assertIsNone(found.report)
        self.assertEqual([p["number"] for p in found.pictures.values()], [1, 2])
        # Another range of the same frames is the same pictures.
        self.assertEqual(len(self.found(replace(job, frames=(2, 9))).pictures), 1)
        Path(wanted[0][1].out).unlink()
        self.assertEqual(list(self.found(job).pictures), [wanted[1][1].out])

    def test_pictures_made_with_another_value_of_a_new_option_were_taken_over(self):
        @dataclass(frozen=True)
        class LaterJob(FileJob):
            gamma: float = 1.0

        frame, picture = next(self.job.wanted())
        plain, brighter = (
            LaterJob(**{**asdict(self.job), "pictures": self.job.pictures, "gamma": gamma})
            for gamma in (1.0, 2.2)
        )
        keys = [job.picture_key(frame, picture) for job in (plain, brighter)]
        self.assertNotEqual(*keys)
        self.assertNotEqual(plain.key(), brighter.key())

    def test_only_what_is_named_changes_no_picture(self):
        frame, picture = next(self.job.wanted())
        known = {one.name for one in fields(FileJob)}
        self.assertLessEqual({*OF_A_RUN, *BESIDE_PICTURES}, known)
        for name in known:
            other = replace(self.job, **{name: ()})  # a value that none of them has
            if getattr(self.job, name) == ():
                other = replace(self.job, **{name: ("a",)})
            same = other.picture_key(frame, picture) == self.job.picture_key(frame, picture)
            self.assertEqual(same, name in OF_A_RUN + BESIDE_PICTURES, name)

    def test_half_a_line_of_a_killed_run_harms_nothing(self):
        self.note()
        whole = Path(self.log).read_bytes()
        for cut in range(1, len(whole), 7):
            Path(self.log).write_bytes(whole[:cut])
            self.found()
        Path(self.log).write_bytes(whole[:-40])
        self.assertIsNone(self.found().report)
        self.note()  # begins a new line
        self.assertIsNotNone(self.found().report)

    def test_any_other_content_is_no_reason_to_fail_or_to_skip(self):
        self.note()
        good = [json.loads(line) for line in Path(self.log).read_text().splitlines()]
        for junk in (None, 1, [], {}, "x", {"x": 1}, [[1]], [["a", 5]]):
            for line in range(2):
                for key in set(good[line]) - ({"file"} if line == 0 else set()):
                    lines = [dict(value) for value in good]
                    lines[line][key] = junk
                    text = "\n".join(["nonsense", "[" * 99999, *map(json.dumps, lines)])
                    Path(self.log).write_text(text)
                    self.assertIsNone(self.found().report, (key, junk))


if __name__ == "__main__":
    unittest.main()
