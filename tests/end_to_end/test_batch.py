# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards batch.py: the exit code tells what happened, and an old picture outlives a failure."""

import json
import os
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import zlib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BATCH = ROOT / "blender_addon" / "lodestone" / "batch.py"
STAGE = Path(os.environ.get("LODESTONE_STAGE") or ROOT / "build" / "release" / "stage")

MAKE = """
import bpy, sys
folder, *kinds = sys.argv[sys.argv.index("--") + 1 :]
for kind in kinds:
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = 64, 36
    scene.view_settings.view_transform = "Standard"
    def place(name, data, location=(0, 0, 0)):
        item = bpy.data.objects.new(name, data)
        item.location = location
        scene.collection.objects.link(item)
        return item
    if kind != "no_camera":
        for name, height in (("Camera", 10), ("High", 40)):
            camera = place(name, bpy.data.cameras.new(name), (0, 0, height))
            scene.camera = scene.camera or camera
    place("Sun", bpy.data.lights.new("Sun", "SUN")).data.energy = 3
    if kind != "no_objects":
        bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=6, location=(1, 0, 0))
        bpy.context.object.name = "Ball" if kind != "names" else 'q"uote\\n{brace} \\u540d'
    if kind == "animated":
        ball = bpy.context.object
        for frame in (1, 2):
            ball.location.x = 2 * frame - 3
            ball.keyframe_insert("location", frame=frame)
    if kind == "volume":
        place("Smoke", bpy.data.volumes.new("Smoke"))
        place("Ink", bpy.data.grease_pencils.new("Ink"))
        scene.use_nodes = True
    bpy.ops.wm.save_as_mainfile(filepath=f"{folder}/{kind}.blend")
"""


def size_of(png):
    """Of a PNG whose checksum of the header is right."""
    data = Path(png).read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", "not a PNG"
    assert zlib.crc32(data[12:29]) == struct.unpack(">I", data[29:33])[0]
    return struct.unpack(">II", data[16:24])


class Batch(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if not (STAGE / "addons" / "lodestone" / "batch.py").is_file():
            raise unittest.SkipTest("the add-on is not staged")
        cls.made = Path(tempfile.mkdtemp())
        script = cls.made / "make.py"
        script.write_text(MAKE)
        kinds = ("plain", "no_camera", "no_objects", "names", "animated", "volume")
        command = ["blender", "-b", "--factory-startup", "--python-exit-code", "1"]
        command += ["--python", str(script), "--", str(cls.made), *kinds]
        subprocess.run(command, check=True, capture_output=True)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.made)

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.out = self.folder / "picture.png"
        self.json = self.folder / "report.json"
        self.environment = dict(os.environ, LODESTONE_STAGE=str(STAGE))

    def blend(self, kind="plain"):
        return str(shutil.copy(self.made / f"{kind}.blend", self.folder))

    def run_batch(self, *arguments):
        done = subprocess.run(
            ["/usr/bin/python3", str(BATCH), *arguments, "--json", str(self.json)],
            capture_output=True,
            text=True,
            env=self.environment,
            timeout=120,
        )
        self.said = done.stdout + done.stderr
        return done.returncode

    def report(self):
        return json.loads(self.json.read_text())

    def fails(self, code, words, *arguments):
        """The code, a sentence, the old picture, and nothing else left behind."""
        self.out.write_bytes(b"last night's picture")
        self.assertEqual(self.run_batch(*arguments), code, self.said)
        self.assertRegex(self.said, words)
        self.assertNotIn("Traceback", self.said)
        self.assertEqual(self.out.read_bytes(), b"last night's picture")
        self.assertEqual(self.report()["exit_code"], code)
        self.assertIn("message", self.report())

    def povray(self, script):
        program = self.folder / "povray"
        program.write_text("#!/bin/sh\n" + script)
        program.chmod(0o755)
        self.environment["LODESTONE_POVRAY"] = str(program)

    # ---- Fine ----

    def test_a_picture_and_its_report(self):
        blend = self.blend()
        code = self.run_batch("render", blend, "--out", str(self.out), "--pixel-error", "2")
        self.assertEqual(code, 0, self.said)
        self.assertEqual(size_of(self.out), (64, 36))
        report = self.report()
        self.assertEqual((report["schema"], report["status"]), (1, "done"))
        self.assertEqual(report["pixel_error"], 2.0)
        self.assertEqual(report["model"]["triangles_unique"], 20480)
        self.assertEqual(sum(report["cut"]["kinds"].values()), 1)
        self.assertLess(report["cut"]["triangles"], 20480)
        self.assertGreater(report["povray"]["peak_bytes"], 1 << 20)
        self.assertGreater(report["build"]["built"], 0)
        self.assertEqual(report["problems"], [])
        self.assertIn(str(self.out), self.said)
        left = {p.name for p in self.folder.iterdir()}
        self.assertEqual(left, {"plain.blend", "picture.png", "report.json", "lodestone"})

    def test_originals_need_no_levels(self):
        code = self.run_batch("render", self.blend(), "--out", str(self.out), "--pixel-error=0")
        self.assertEqual(code, 0, self.said)
        self.assertEqual(self.report()["cut"]["triangles"], 20480)
        self.assertNotIn("build", self.report())

    def test_any_name_renders(self):
        code = self.run_batch("render", self.blend("names"), "--out", str(self.out))
        self.assertEqual(code, 0, self.said)

    def test_many_pictures_from_one_reading(self):
        views = [
            {"out": str(self.folder / "a.png"), "pixel_error": 0, "antialias": "off"},
            {"out": str(self.folder / "b.png"), "camera": "High", "size": "32x18"},
            {"out": str(self.folder / "c.png"), "false_color": True},
            {"out": str(self.folder / "d.png"), "covered_only": True},
        ]
        (self.folder / "views.json").write_text(json.dumps(views))
        path = str(self.folder / "views.json")
        code = self.run_batch("render", self.blend(), "--views", path, "--keep-exr")
        self.assertEqual(code, 0, self.said)
        pictures = self.report()["pictures"]
        self.assertEqual([p["camera"] for p in pictures], ["Camera", "High", "Camera", "Camera"])
        self.assertEqual([p["pixel_error"] for p in pictures], [0.0, 1.0, 1.0, 1.0])
        self.assertEqual(size_of(views[1]["out"]), (32, 18))
        for picture in pictures:
            self.assertTrue({"cut", "export", "povray", "picture"} <= set(picture))
        self.assertTrue((self.folder / "a.exr").is_file())

    def test_frames_are_numbered_pictures(self):
        out = self.folder / "frames"
        code = self.run_batch(
            "render", self.blend("animated"), "--out", str(out), "--frames", "1-2"
        )
        self.assertEqual(code, 0, self.said)
        names = sorted(p.name for p in out.iterdir())
        self.assertEqual(names, ["animated_0001.png", "animated_0002.png"])
        first, second = ((out / name).read_bytes() for name in names)
        self.assertNotEqual(first, second)

    def test_building_then_exporting(self):
        blend = self.blend()
        self.assertEqual(self.run_batch("build", blend), 0, self.said)
        self.assertGreater(self.report()["build"]["built"], 0)
        self.assertEqual(self.run_batch("build", blend), 0, self.said)
        self.assertEqual(self.report()["build"]["built"], 0)
        scene = self.folder / "scene"
        self.assertEqual(self.run_batch("export", blend, "--out", str(scene)), 0, self.said)
        self.assertTrue((scene / "scene.pov").is_file())
        self.assertGreater(self.report()["export"]["bytes"], 0)

    def test_comparing_tells_how_levels_differ_from_originals(self):
        blend, page = self.blend(), self.folder / "page.html"
        out = ("--out", str(self.out), "--html", str(page))
        code = self.run_batch("compare", blend, "--pixel-error", "4", *out)
        self.assertEqual(code, 0, self.said)
        for name in ("picture", "picture_originals", "picture_levels"):
            self.assertEqual(size_of(self.folder / f"{name}.png"), (64, 36))
        report = self.report()
        found, before = report["compare"], report["originals"]
        self.assertEqual(before["cut"]["triangles"], 20480)
        self.assertLess(report["cut"]["triangles"], 2048)
        self.assertTrue(0.0 < found["mean"] < found["p999"] <= found["max"] <= 1.0, found)
        self.assertTrue(0.5 < found["ssim"] < 1.0, found)
        self.assertGreater(before["povray"]["wall_s"], 0.0)
        self.assertEqual([one["object"] for one in found["worst"]], ["Ball"])
        self.assertEqual(report["levels_picture"], str(self.folder / "picture_levels.png"))
        self.assertIn(f"SSIM {found['ssim']:.4f}; ", self.said)
        self.assertIn("of 20.5 k triangles, POV-Ray ", self.said)
        text = page.read_text()
        self.assertIn(f"SSIM {found['ssim']:.4f}", text)
        self.assertIn("most: <bdi>Ball</bdi>", text)
        left = {p.name for p in (self.folder / "lodestone").iterdir()}
        self.assertEqual(left, {"plain"}, "scene files are left")
        for path in self.folder.glob("picture*.png"):
            path.unlink()
        arguments = ("compare", blend, "--pixel-error", "0", "--out", str(self.out))
        self.fails(1, "nothing to compare", *arguments)

    def test_the_store_goes_where_it_is_told(self):
        store = self.folder / "store"
        self.assertEqual(self.run_batch("build", self.blend(), "--store", str(store)), 0)
        self.assertTrue((store / "tileset.json").is_file())
        self.assertFalse((self.folder / "lodestone").exists())

    def test_a_picture_that_lacks_something_says_so(self):
        blend = self.blend("volume")
        self.assertEqual(self.run_batch("render", blend, "--out", str(self.out)), 3, self.said)
        self.assertIn("Smoke", self.said)
        self.assertRegex(self.said, 'error: .*"Ink" is left out')
        self.assertIn("compositor", {item["code"] for item in self.report()["problems"]})
        self.assertEqual(size_of(self.out), (64, 36))
        again = self.run_batch("render", blend, "--out", str(self.out), "--strict")
        self.assertEqual(again, 1)

    def test_several_files_go_on_past_a_broken_one(self):
        broken = self.folder / "broken.blend"
        broken.write_bytes(b"BLENDER-v304" + bytes(1000))
        out = self.folder / "pictures"
        code = self.run_batch("render", str(broken), self.blend(), "--out", str(out))
        self.assertEqual(code, 1, self.said)
        self.assertEqual([f["exit_code"] for f in self.report()["files"]], [4, 0])
        self.assertEqual(size_of(out / "plain.png"), (64, 36))

    # ---- Failing ----

    def test_usage(self):
        self.assertEqual(self.run_batch("render"), 2)
        self.assertEqual(self.run_batch("paint", "x.blend"), 2)

    def test_an_unbuilt_checkout_names_the_build_command(self):
        self.environment["LODESTONE_STAGE"] = str(self.folder)
        self.assertEqual(self.run_batch("build", "x.blend"), 2)
        self.assertIn("cmake --build", self.said)

    def test_a_missing_file(self):
        self.fails(4, "does not exist", "render", "/nowhere.blend", "--out", str(self.out))

    def test_a_file_that_is_no_blend(self):
        blend = self.folder / "no.blend"
        blend.write_text("hello")
        self.fails(4, "cannot read", "render", str(blend), "--out", str(self.out))

    def test_no_camera(self):
        blend = self.blend("no_camera")
        self.fails(1, "no camera", "render", blend, "--out", str(self.out))

    def test_no_such_camera(self):
        arguments = ("--out", str(self.out), "--camera", "Near")
        self.fails(1, '"Near"', "render", self.blend(), *arguments)

    def test_no_objects(self):
        blend = self.blend("no_objects")
        self.fails(1, "(?i)nothing to", "render", blend, "--out", str(self.out))

    def test_povray_missing(self):
        self.environment["LODESTONE_POVRAY"] = "/nowhere/povray"
        self.fails(5, "/nowhere/povray", "render", self.blend(), "--out", str(self.out))

    def test_povray_failing(self):
        self.povray("echo 'Parse Error: no such thing' >&2; exit 1\n")
        self.fails(5, "no such thing", "render", self.blend(), "--out", str(self.out))

    def test_povray_killed(self):
        self.povray("kill -KILL $$\n")
        self.fails(5, "(?i)kill|signal", "render", self.blend(), "--out", str(self.out))

    def test_blender_killed_by_a_signal_without_a_name(self):
        blender = self.folder / "dying_blender"
        blender.write_text("#!/bin/sh\nkill -40 $$\n")
        blender.chmod(0o755)
        arguments = ("--out", str(self.out), "--blender", str(blender))
        self.fails(4, r"died on the file \(signal 40\)", "render", self.blend(), *arguments)

    def test_an_output_that_cannot_be_written(self):
        (self.folder / "file").write_text("no folder")
        out = str(self.folder / "file" / "picture.png")
        self.fails(1, "file", "render", self.blend(), "--out", out)

    def test_an_output_that_is_a_folder(self):
        folder = self.folder / "a.png"
        folder.mkdir()
        self.fails(1, "folder", "render", self.blend(), "--out", str(folder))

    def test_blender_missing(self):
        arguments = ("--out", str(self.out), "--blender", "/nowhere/blender")
        self.fails(1, "/nowhere/blender", "render", self.blend(), *arguments)

    def test_blender_dying(self):
        program = self.folder / "blender"
        program.write_text("#!/bin/sh\necho the last words\nkill -SEGV $$\n")
        program.chmod(0o755)
        arguments = ("--out", str(self.out), "--blender", str(program))
        self.fails(4, "SIGSEGV", "render", self.blend(), *arguments)
        self.assertIn("the last words", self.said)

    def test_a_file_that_takes_too_long(self):
        self.povray("sleep 60\n")
        arguments = ("--out", str(self.out), "--timeout", "4")
        self.fails(1, "--timeout", "render", self.blend(), *arguments)

    def test_cancelling_leaves_nothing_running(self):
        self.povray("echo $$ > %s/pid; exec sleep 60\n" % self.folder)
        self.out.write_bytes(b"last night's picture")
        command = ["/usr/bin/python3", str(BATCH), "render", self.blend(), "--out", str(self.out)]
        child = subprocess.Popen(command, env=self.environment, stderr=subprocess.DEVNULL)
        pid = self.folder / "pid"
        for _ in range(600):
            if pid.is_file() and pid.read_text().strip():
                break
            time.sleep(0.1)
        child.send_signal(signal.SIGINT)
        self.assertEqual(child.wait(10), 130)
        self.assertEqual(self.out.read_bytes(), b"last night's picture")
        self.assertFalse(Path(f"/proc/{pid.read_text().strip()}").exists())


class CommandLine(unittest.TestCase):
    """`blender -b FILE --addons lodestone -E LODESTONE_POVRAY -f 1`, as farms send it."""

    def setUp(self):
        if not (STAGE / "addons" / "lodestone" / "batch.py").is_file():
            self.skipTest("the add-on is not staged")
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        (self.folder / "make.py").write_text(MAKE)

    def make(self, kind):
        command = ["blender", "-b", "--factory-startup", "--python-exit-code", "1"]
        command += ["--python", str(self.folder / "make.py"), "--", str(self.folder), kind]
        subprocess.run(command, check=True, capture_output=True)
        return str(self.folder / f"{kind}.blend")

    def render(self, kind="plain", **environment):
        command = ["blender", "-b", "--factory-startup", self.make(kind), "--addons", "lodestone"]
        command += ["-E", "LODESTONE_POVRAY", "-o", str(self.folder / "frame_####"), "-F", "PNG"]
        changed = {**os.environ, "BLENDER_USER_SCRIPTS": str(STAGE), **environment}
        done = subprocess.run([*command, "-f", "1"], capture_output=True, text=True, env=changed)
        self.said = done.stdout + done.stderr
        return done.returncode

    def test_no_camera_and_no_objects_are_failures(self):
        for kind in ("no_camera", "no_objects"):
            self.assertEqual(self.render(kind), 1, self.said)
            self.assertRegex(self.said, "(?i)no camera|nothing to render")
            self.assertFalse((self.folder / "frame_0001.png").exists())

    def test_the_picture_is_batchs_but_for_dither(self):
        self.assertEqual(self.render(), 0, self.said)
        out = self.folder / "batch.png"
        subprocess.run(
            ["/usr/bin/python3", str(BATCH), "render", str(self.folder / "plain.blend")]
            + ["--out", str(out)],
            check=True,
            capture_output=True,
            env={**os.environ, "LODESTONE_STAGE": str(STAGE)},
        )
        sys.path.insert(0, str(STAGE / "addons" / "lodestone"))
        import lodestone_native as native

        found = native.image_compare(str(self.folder / "frame_0001.png"), str(out))
        self.assertLessEqual(found.max, 2.5 / 255)


if __name__ == "__main__":
    unittest.main()
