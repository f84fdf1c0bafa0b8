# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards a night of batch.py: no file stops another, and what was killed is gone and resumed."""

import json
import os
import shutil
import signal
import struct
import subprocess
import tempfile
import time
import unittest
from html import unescape
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BATCH = ROOT / "blender_addon" / "lodestone" / "batch.py"
STAGE = Path(os.environ.get("LODESTONE_STAGE") or ROOT / "build" / "release" / "stage")
SLOW = {"hangs", "greedy"}  # these are stopped, so they are begun early


def wreck_polygons(path):
    """Makes the first polygon of a .blend use corners that are not there: Blender does not check
    them and dies."""
    data = bytearray(path.read_bytes())
    blocks, at = [], 12
    while data[at : at + 4] != b"ENDB":
        code, size, _, kind, _ = struct.unpack_from("<4siQii", data, at)
        blocks.append((at + 24, code, kind, size))
        at += 24 + size
    dna = next(start for start, code, _, _ in blocks if code == b"DNA1")
    wanted = _struct_number(data, dna, b"MPoly")
    start = next(start for start, code, kind, _ in blocks if (code, kind) == (b"DATA", wanted))
    struct.pack_into("<i", data, start, 0x7FFFFF00)  # MPoly.loopstart
    path.write_bytes(data)


def _struct_number(data, dna, name):
    """The number of a structure in the catalogue of a .blend."""
    at = data.index(b"TYPE", dna)
    (count,) = struct.unpack_from("<i", data, at + 4)
    types, at = data[at + 8 :].split(b"\0", count)[:count], data.index(b"STRC", at)
    (count,) = struct.unpack_from("<i", data, at + 4)
    at += 8
    for number in range(count):
        type_, fields = struct.unpack_from("<hh", data, at)
        if types[type_] == name:
            return number
        at += 4 + 4 * fields
    raise AssertionError(f"no {name}")


def processes_of(folder):
    """Living processes that work in the folder, or were told its name."""
    found = []
    for place in Path("/proc").iterdir():
        if not place.name.isdecimal() or int(place.name) == os.getpid():
            continue
        try:
            about = [os.readlink(place / "cwd"), (place / "environ").read_text("utf-8", "replace")]
        except OSError:
            continue
        if any(str(folder) in text for text in about):
            found.append(f"{place.name} {(place / 'comm').read_text().strip()}")
    return found


class Many(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if not (STAGE / "addons" / "lodestone" / "batch.py").is_file():
            raise unittest.SkipTest("the add-on is not staged")
        cls.made = Path(tempfile.mkdtemp())
        command = ["blender", "-b", "--factory-startup", "--addons", "lodestone"]
        command += ["--python-exit-code", "1", "--python", str(Path(__file__).parent)]
        command[-1] += "/batch_scenes.py"
        environment = {**os.environ, "BLENDER_USER_SCRIPTS": str(STAGE)}
        done = subprocess.run(
            [*command, "--", str(cls.made)], env=environment, capture_output=True, text=True
        )
        assert done.returncode == 0, done.stdout + done.stderr
        wreck_polygons(cls.made / "crashes.blend")
        newer = cls.made / "newer.blend"
        newer.write_bytes(newer.read_bytes().replace(b"BLENDER-v304", b"BLENDER-v402", 1))

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.made)

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="lodestone-test-"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.temporary = self.folder / "tmp"
        self.temporary.mkdir()
        # By it processes_of() knows whatever inherits our environment.
        self.environment = {
            **os.environ,
            "LODESTONE_STAGE": str(STAGE),
            "TMPDIR": str(self.temporary),
        }
        self.log = self.folder / "night.jsonl"
        self.page = self.folder / "night.html"
        self.json = self.folder / "night.json"
        self.out = self.folder / "pictures"

    def take(self, *names):
        return [str(shutil.copy(self.made / f"{name}.blend", self.folder)) for name in names]

    def command(self, *arguments):
        command = ["/usr/bin/python3", str(BATCH), "render", "--log", str(self.log)]
        return [*command, "--json", str(self.json), "--out", str(self.out), *arguments]

    def run_batch(self, *arguments):
        done = subprocess.run(
            self.command(*arguments),
            capture_output=True,
            text=True,
            env=self.environment,
            timeout=240,
        )
        self.said, self.table = done.stdout + done.stderr, done.stdout
        self.assertNotIn("Traceback", self.said)
        return done.returncode

    def begin(self, *arguments):
        return subprocess.Popen(
            self.command(*arguments),
            env=self.environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )

    def lines(self, kind):
        found = []
        if self.log.is_file():
            for text in self.log.read_text().splitlines():
                try:
                    found.append(json.loads(text))
                except ValueError:
                    pass
        return [line for line in found if line["line"] == kind]

    def finished(self):
        return sum(line["report"]["exit_code"] in (0, 3) for line in self.lines("file"))

    def wait_for(self, condition, what, seconds=120.0):
        end = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > end:
                self.fail(f"still no {what} after {seconds} s")
            time.sleep(0.02)

    def nothing_runs(self, seconds=2.0):
        end = time.monotonic() + seconds
        while processes_of(self.folder) and time.monotonic() < end:
            time.sleep(0.02)
        self.assertEqual(processes_of(self.folder), [])

    def povray(self, script):
        program = self.folder / "povray"
        program.write_text("#!/bin/sh\n" + script)
        program.chmod(0o755)
        self.environment["LODESTONE_POVRAY"] = str(program)

    def test_a_page_that_cannot_be_written_is_complained_about_once(self):
        page = self.folder / "nowhere" / "night.html"
        self.run_batch("none.blend", "neither.blend", "--html", str(page))
        self.assertEqual(self.said.count("the page cannot be written"), 1, self.said)
        self.assertNotIn(".page-", self.said)

    def test_a_folder_is_called_a_folder(self):
        (self.folder / "folder.blend").mkdir()
        self.run_batch(str(self.folder / "folder.blend"), "none.blend")
        self.assertIn("is a folder", self.said)

    # ---- The night ----

    def test_twenty_files_are_killed_and_resumed_and_end_with_the_right_table(self):
        every = sorted(path.stem for path in self.made.glob("*.blend"))
        every = [name for name in every if name != "animated"]
        every.sort(key=lambda name: (name not in SLOW, name))
        self.assertEqual(len(every), 20)
        files = self.take(*every)
        options = ["--jobs", "2", "--timeout", "30", "--max-memory", "700M", "--trust-scripts"]

        first = self.begin(*files, *options)
        self.wait_for(lambda: self.finished() >= 4, "four pictures")
        first.kill()
        first.wait()
        before = {line["file"]: line for line in self.lines("file")}
        self.nothing_runs()
        with open(self.log, "a") as file:
            file.write('{"line": "file", "file": "half a li')

        code = self.run_batch(*files, *options, "--resume", "--html", str(self.page))
        self.assertEqual(code, 1, self.said)
        reports = json.loads(self.json.read_text())["files"]
        self.assertEqual([report["input"] for report in reports], files)
        expected = {
            "crashes": (4, "crash", "SIGSEGV.*Blender 3.4"),
            "hangs": (1, "timeout", "30 s of --timeout"),
            "greedy": (1, "memory", r"7\d\d MB of memory.* 700 MB of --max-memory \(blender"),
            "lacks": (3, None, "library.blend"),
            "newer": (3, None, r"Blender 4\.2"),
        }
        for name, report in zip(every, reports):
            code, cause, words = expected.get(name, (0, None, ""))
            self.assertEqual((report["exit_code"], report.get("cause")), (code, cause), report)
            self.assertRegex(report.get("message", "no message"), words or "^no message$")
            done = code in (0, 3)
            self.assertEqual((self.out / f"{name}.png").is_file(), done, name)
            self.assertEqual("log" in report, code != 0, name)
            known = before.get(report["input"], {"report": {"exit_code": 1}})["report"]
            self.assertEqual(report.get("resumed", False), known["exit_code"] in (0, 3), name)
            self.assertGreater(report["memory"]["peak_bytes"], 50e6)
        self.assertEqual(reports[every.index("forest")]["model"]["placements"], 5000)
        self.assertGreaterEqual(sum("resumed" in report for report in reports), 4)

        table = self.table[self.table.rindex("status  ") :].splitlines()
        self.assertEqual(len(table), 22)
        names = [line.split()[0] for line in table[1:6]]
        self.assertEqual(set(names[:3]), {"crash", "timeout", "memory"})
        self.assertEqual(names[3:], ["incomplete", "incomplete"])
        self.assertEqual(table[-1], "20 files: 3 failed, 2 incomplete, 15 done")
        self.look_at_page(reports)
        self.nothing_runs()
        self.assertEqual(list(self.temporary.iterdir()), [])
        self.assertFalse([path for path in self.folder.rglob("*") if "in_use" in path.name])

    def look_at_page(self, reports):
        text = self.page.read_text()
        self.assertLess(text.index("crashes.blend"), text.index("plain0.blend"))
        self.assertEqual(text.count("<tr"), 21)
        self.assertEqual(text.count("data:image/jpeg;base64,"), 17)
        self.assertNotIn("<b>", text)
        self.assertIn("q\"uo'te <b>.blend", unescape(text))
        for report in reports:
            if "log" in report:
                self.assertIn(f'./night.files/{Path(report["log"]).name}', text)
                self.assertIn("Blender 3.4.1", Path(report["log"]).read_text())
        crash = next(r["log"] for r in reports if r["input"].endswith("crashes.blend"))
        self.assertIn("# backtrace", Path(crash).read_text())

    # ---- Being killed ----

    def test_killing_batch_kills_blender_and_povray_and_the_next_run_clears_up(self):
        self.povray(f"echo $$ > {self.folder}/pid; exec sleep 60\n")
        (blend,) = self.take("plain0")
        run = self.begin(blend, "--out", str(self.out) + ".png")
        self.wait_for((self.folder / "pid").is_file, "POV-Ray")
        self.wait_for(lambda: (self.folder / "pid").read_text().strip(), "POV-Ray")
        self.assertGreaterEqual(len(processes_of(self.folder)), 3)
        run.kill()
        run.wait()
        self.nothing_runs()
        scenes = list((self.folder / "lodestone").glob("plain0.scene-*"))
        self.assertEqual(len(scenes), 1)
        self.assertEqual(len(list(self.temporary.iterdir())), 1)
        del self.environment["LODESTONE_POVRAY"]
        code = self.run_batch(blend, "--out", str(self.out) + ".png", "--resume")
        self.assertEqual(code, 0, self.said)
        self.assertFalse(scenes[0].exists())
        self.assertEqual(os.listdir(self.folder / "lodestone"), ["plain0"])
        self.assertEqual(list(self.temporary.iterdir()), [])

    def test_ctrl_c_stops_all_within_a_second_and_says_what_is_not_done(self):
        self.povray(f"trap '' TERM; echo x >> {self.folder}/began; sleep 60; sleep 60\n")
        files = self.take("plain0", "plain1", "plain2")
        run = self.begin(*files, "--jobs", "2")
        began = self.folder / "began"
        self.wait_for(lambda: began.is_file() and len(began.read_text()) == 4, "two POV-Rays")
        start = time.monotonic()
        run.send_signal(signal.SIGTERM)
        self.assertEqual(run.wait(10), 130)
        self.assertLess(time.monotonic() - start, 1.5)
        self.nothing_runs(0.0)
        lines = [(line["file"], line["report"]["cause"]) for line in self.lines("file")]
        self.assertEqual(sorted(lines), list(zip(files, ["cancelled", "cancelled", "not_begun"])))
        self.assertEqual({line["report"]["exit_code"] for line in self.lines("file")}, {130})
        self.assertFalse(list((self.folder / "lodestone").glob("*.scene*")))

    # ---- Frames ----

    def test_frames_that_are_there_are_left_alone_and_a_killed_animation_goes_on(self):
        (blend,) = self.take("animated")
        frames = [self.out / f"animated_{number:04}.png" for number in range(1, 5)]
        run = self.begin(blend, "--frames", "1-4")
        self.wait_for(lambda: len(self.lines("picture")) >= 2, "two frames")
        run.kill()
        run.wait()
        self.nothing_runs()
        first = frames[0].stat().st_mtime_ns
        frames[1].write_bytes(frames[1].read_bytes()[:-9])

        self.assertEqual(self.run_batch(blend, "--frames", "1-4", "--resume"), 0, self.said)
        report = json.loads(self.json.read_text())
        self.assertEqual([picture["frame"] for picture in report["pictures"]], list(range(1, 5)))
        self.assertTrue(all("cut" in picture for picture in report["pictures"]))
        self.assertEqual(report["resumed"], len(self.lines("picture")) - 4)
        self.assertEqual(frames[0].stat().st_mtime_ns, first)

        keep = frames[2].stat().st_mtime_ns
        frames[1].unlink()
        frames[3].write_bytes(frames[3].read_bytes()[:100])
        code = self.run_batch(blend, "--frames", "1-4", "--skip-existing")
        self.assertEqual(code, 0, self.said)
        pictures = json.loads(self.json.read_text())["pictures"]
        self.assertEqual(
            [picture.get("skipped", False) for picture in pictures],
            [True, False, True, False],
        )
        self.assertEqual(frames[2].stat().st_mtime_ns, keep)
        self.assertEqual(frames[1].read_bytes()[:4], b"\x89PNG")

    # ---- Settings ----

    def test_the_command_line_wins_over_the_profile_and_that_over_the_file(self):
        profile = self.folder / "farm.json"
        profile.write_text('{"pixel_error": 3, "size": "24x16", "keep": "always"}')
        files = self.take("plain0")
        code = self.run_batch(
            *files, "--profile", str(profile), "--size=20x10", "--out", str(self.out) + ".png"
        )
        self.assertEqual(code, 0, self.said)
        report = json.loads(self.json.read_text())
        self.assertEqual((report["pixel_error"], report["antialias"]), (3.0, "off"))
        self.assertEqual(report["size"], [20, 10])
        self.assertTrue((self.folder / "lodestone" / "plain0.scene" / "scene.pov").is_file())

    def test_scripts_and_drivers_do_not_run_unless_trusted(self):
        files = self.take("hangs", "driven")
        self.assertEqual(self.run_batch(*files, "--jobs", "2"), 3, self.said)
        reports = json.loads(self.json.read_text())["files"]
        self.assertEqual([report["exit_code"] for report in reports], [0, 3])
        self.assertEqual([p["code"] for p in reports[1]["problems"]], ["driver_not_run"])
        log = Path(reports[1]["log"])
        self.assertTrue(log.is_file())
        still = (self.out / "driven.png").read_bytes()
        code = self.run_batch(files[1], "--trust-scripts", "--out", str(self.out / "driven.png"))
        self.assertEqual(code, 0, self.said)
        self.assertNotEqual((self.out / "driven.png").read_bytes(), still)
        self.assertFalse(log.exists())


if __name__ == "__main__":
    unittest.main()
