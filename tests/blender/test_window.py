# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards work in a real window, under Xvfb: Update Levels, its dialog, Esc, F12 and Esc."""

import os
import shutil
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import povray_state

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
STAGE = Path(os.environ.get("LODESTONE_STAGE") or ROOT / "build" / "release" / "stage")
# Without a graphics card most of the time goes into pixels. For who does not look at them:
SMALL = ("--window-geometry", "0", "0", "640", "400")


class Window(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        for program in ("Xvfb", "xdotool"):
            if shutil.which(program) is None:
                raise unittest.SkipTest(f"{program} is not installed")
        if not (STAGE / "addons" / "lodestone" / "__init__.py").is_file():
            raise unittest.SkipTest("the add-on is not staged")
        read, write = os.pipe()
        command = ["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x800x24"]
        cls.server = subprocess.Popen(
            [*command, "+extension", "GLX"], pass_fds=[write], stderr=subprocess.DEVNULL
        )
        os.close(write)
        with os.fdopen(read) as told:
            cls.display = ":" + told.readline().strip()

    @classmethod
    def tearDownClass(cls):
        cls.server.terminate()
        cls.server.wait()

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.environment = {
            **os.environ,
            "DISPLAY": self.display,
            "BLENDER_USER_SCRIPTS": str(STAGE),
            "BLENDER_USER_CONFIG": str(self.folder / "config"),
        }

    def blender(self, script, *options):
        self.log = self.folder / "log"
        with open(self.log, "wb") as log:
            child = subprocess.Popen(
                ["blender", "--factory-startup", *options, "--python", str(HERE / script)]
                + ["--", str(self.folder)],
                env=self.environment,
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=subprocess.STDOUT,
            )
        self.addCleanup(self._end, child)
        return child

    def _end(self, child):
        if child.poll() is None:
            child.kill()
            child.wait()

    def succeeds(self, child):
        code = child.wait(240)
        said = self.log.read_text("utf-8", "replace")
        self.assertEqual(code, 0, said)
        self.assertIn("WINDOW STEPS DONE", said)
        self.assertNotIn("Traceback", said)

    def test_update_levels(self):
        self.succeeds(self.blender("window_update_levels.py", "--enable-event-simulate", *SMALL))

    def test_seeing(self):
        self.succeeds(self.blender("window_seeing.py", "--enable-event-simulate", *SMALL))

    def test_writing_is_allowed_after_a_render_that_began_while_a_panel_was_drawn(self):
        self.succeeds(self.blender("window_whole_panels.py", *SMALL))

    def test_viewport(self):
        child = self.blender("window_viewport.py", *SMALL)
        code = child.wait(240)
        said = self.log.read_text("utf-8", "replace")
        self.assertEqual(code, 0, said)
        self.assertIn("WINDOW STEPS DONE", said)
        self.assertEqual(said.count("Traceback"), 1, said)  # of what is broken on purpose
        self.assertEqual(said.count("RuntimeError: broken on purpose"), 1)

    def test_auto_structure(self):
        self.succeeds(self.blender("window_auto_structure.py", "--enable-event-simulate"))
        kept = os.environ.get("LODESTONE_SCREENS")
        if kept:
            shutil.copytree(self.folder, kept, dirs_exist_ok=True)

    def test_every_properties_tab_draws_under_our_engine(self):
        self.succeeds(self.blender("window_panels.py"))
        said = self.log.read_text("utf-8", "replace")
        # What Blender says of a layout that names a property, operator or panel that is not there
        for complaint in ("rna_uiItem", "unknown operator", "not found:", "Error:"):
            self.assertNotIn(complaint, said)
        pictures = {path.name for path in self.folder.glob("*.png")}
        self.assertLessEqual({"render.png", "material.png", "data_key.png"}, pictures)
        kept = os.environ.get("LODESTONE_SCREENS")  # for who wants to look at them
        if kept:
            shutil.copytree(self.folder, kept, dirs_exist_ok=True)

    def test_disabling_the_addon_stops_what_runs_and_crashes_nothing(self):
        program = self.folder / "povray"
        program.write_text("#!/bin/sh\nexec sleep 60\n")
        program.chmod(0o755)
        self.environment["LODESTONE_POVRAY"] = str(program)
        self.succeeds(self.blender("window_disable.py", *SMALL))

    def test_escape_stops_povray_within_a_second(self):
        pid = self.folder / "pid"
        program = self.folder / "povray"
        state = self.folder / "state"
        state.write_bytes(povray_state.rectangle(0, 0, 31, 31, (0.0, 0.5, 0.0)))
        program.write_text(
            f"#!/bin/sh\nstem=${{2#+O}}\ncp {state} ${{stem%.*}}.pov-state\n"
            f"echo Rendered 1024 of 2304 pixels\necho $$ > {pid}\nexec sleep 60\n"
        )
        program.chmod(0o755)
        self.environment["LODESTONE_POVRAY"] = str(program)
        child = self.blender("window_render.py")
        end = time.monotonic() + 60
        while not (pid.is_file() and pid.read_text().strip()):
            self.assertLess(time.monotonic(), end, self.log.read_text("utf-8", "replace"))
            self.assertIsNone(child.poll(), self.log.read_text("utf-8", "replace"))
            time.sleep(0.05)
        process = Path("/proc") / pid.read_text().strip()
        time.sleep(0.5)
        subprocess.run(["xdotool", "key", "Escape"], env=self.environment, check=True)
        pressed = time.monotonic()
        while process.exists() and time.monotonic() < pressed + 5:
            time.sleep(0.02)
        self.assertLess(time.monotonic() - pressed, 1.0)
        self.succeeds(child)


if __name__ == "__main__":
    unittest.main()
