# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards that batch.py takes a file of any name, with any names in it, and does nothing else."""

import json
import os
import shutil
import struct
import subprocess
import tempfile
import unittest
from html import unescape
from pathlib import Path

import hostile_names as hostile

ROOT = Path(__file__).resolve().parents[2]
BATCH = ROOT / "blender_addon" / "lodestone" / "batch.py"
STAGE = Path(os.environ.get("LODESTONE_STAGE") or ROOT / "build" / "release" / "stage")
MAKE = """
import sys
import bpy
bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
scene = bpy.context.scene
scene.render.resolution_x, scene.render.resolution_y = 32, 18
def place(name, data, location=(0, 0, 0)):
    item = bpy.data.objects.new(name, data)
    item.location = location
    scene.collection.objects.link(item)
    return item
scene.camera = place("Camera", bpy.data.cameras.new("Camera"), (0, 0, 10))
place("Sun", bpy.data.lights.new("Sun", "SUN")).data.energy = 3
bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=4, radius=2)
ball = bpy.context.object
ball.name, ball.data.name = "Ball.ABCDEFGH", "Mesh.ABCDEFGH"
paint = bpy.data.materials.new("Paint.ABCDEFGH")
paint.diffuse_color = (0.8, 0.2, 0.1, 1)
paint.use_nodes = True
paint.node_tree.nodes.new("ShaderNodeTexImage").image = bpy.data.images.new("Image.ABCDEFGH", 4, 4)
ball.data.materials.append(paint)
bpy.ops.wm.save_as_mainfile(filepath=sys.argv[-1], compress=False)
"""
LONG = hostile.full('"名 $(touch canary)\n', 249).encode()
NAMES = (
    LONG + b"x" * (249 - len(LONG)),
    b"-<b>%s&amp;\x1b[31mcaf\xe9\xff",
    b"..",  # its file is called ...blend
)


def pixels_of(png):
    """Its size and compressed pixels, without what else is told in it."""
    at, found = 8, b""
    while at < len(png):
        size, kind = struct.unpack(">I4s", png[at : at + 8])
        found += png[at + 8 : at + 8 + size] if kind in (b"IHDR", b"IDAT") else b""
        at += 12 + size
    return found


class HostileFiles(unittest.TestCase):
    def setUp(self):
        if not (STAGE / "addons" / "lodestone" / "batch.py").is_file():
            self.skipTest("the add-on is not staged")
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name) / "files"
        (self.folder / "tmp").mkdir(parents=True)
        base = self.folder.parent / "base.blend"
        script = self.folder.parent / "make.py"
        script.write_text(MAKE)
        command = ["blender", "-b", "--factory-startup", "--python-exit-code", "1"]
        command += ["--python", str(script), "--", str(base)]
        subprocess.run(command, check=True, capture_output=True)
        self.files = [name + b".blend" for name in NAMES]
        for name in self.files:
            shutil.copy(base, os.path.join(os.fsencode(self.folder), name))
        data = base.read_bytes()
        for number, kind in enumerate((b"Ball", b"Mesh", b"Paint", b"Image")):
            self.assertIn(kind + b".ABCDEFGH", data)
            name = hostile.BYTES[number].ljust(9, b"\xff")[:9]
            data = data.replace(kind + b".ABCDEFGH", kind + name)
        with open(os.path.join(os.fsencode(self.folder), self.files[0]), "wb") as file:
            file.write(data)

    def batch(self, *options):
        done = subprocess.run(
            ["/usr/bin/python3", str(BATCH), "render", "--jobs", "2", "--json", "../night.json"]
            + ["--log", "../night.jsonl", "--html", "../night.html", "--out", "pictures"]
            + ["--frames", "1-1", "--keep-exr", *options, "--", *self.files],
            cwd=self.folder,
            capture_output=True,
            env={
                **os.environ,
                "LODESTONE_STAGE": str(STAGE),
                "TMPDIR": str(self.folder / "tmp"),
                "LC_ALL": "en_US.UTF-8",
            },
            timeout=120,
        )
        self.said = (done.stdout + done.stderr).decode("utf-8", "strict")
        self.assertNotIn("Traceback", self.said)
        return done.returncode

    def every_path(self):
        root = os.fsencode(self.folder)
        found = set()
        for at, folders, files in os.walk(root):
            found.update(os.path.relpath(os.path.join(at, name), root) for name in files)
        return found

    def test_files_of_any_name_are_rendered_reported_and_resumed(self):
        self.assertEqual(self.batch(), 0, self.said)
        self.look_at_files()
        reports = json.loads((self.folder.parent / "night.json").read_text("utf-8"))["files"]
        root = os.fsencode(self.folder)
        inputs = [os.path.relpath(os.fsencode(report["input"]), root) for report in reports]
        self.assertEqual(inputs, self.files)
        pictures = []
        for report in reports:
            (picture,) = report["pictures"]
            pictures.append(pixels_of(Path(picture["picture"]).read_bytes()))
        self.assertEqual(len(set(pictures)), 1)
        self.assertEqual(struct.unpack(">II", pictures[0][:8]), (32, 18))
        renamed = reports[0]["problems"]
        self.assertEqual({problem["code"] for problem in renamed}, {"unreadable_name"})
        self.assertEqual(len(renamed), 4, renamed)
        self.assertIn("Ballcaf\\xe9", "".join(problem["object"] for problem in renamed))

        lines = (self.folder.parent / "night.jsonl").read_text("ascii").splitlines()
        told = [json.loads(line) for line in lines]
        told = [line["file"] for line in told if line["line"] == "file"]
        self.assertEqual(sorted(told), sorted(report["input"] for report in reports))
        page = (self.folder.parent / "night.html").read_text("utf-8")
        self.assertEqual(page.count("<tr"), 4)
        self.assertNotIn("<b>", page)
        self.assertNotIn("\x1b", page + self.said)
        self.assertIn("-<b>%s&amp;\ufffd[31mcaf\ufffd\ufffd.blend", unescape(page))
        self.assertIn("3 files: 3 done", self.said)

        self.assertEqual(self.batch("--resume"), 0, self.said)
        again = json.loads((self.folder.parent / "night.json").read_text("utf-8"))["files"]
        self.assertEqual([report.get("resumed") for report in again], [True] * 3)

    def look_at_files(self):
        """Pictures, stores and logs; nothing above them, nothing left over, nothing run."""
        made = self.every_path() - set(self.files)
        self.assertEqual([path for path in made if hostile.CANARY.encode() == path[-6:]], [])
        folders = {path.split(b"/")[0] for path in made}
        self.assertEqual(folders, {b"pictures", b"lodestone"})
        pictures = [path for path in made if path.startswith(b"pictures/")]
        self.assertEqual(len(pictures), 2 * len(self.files), pictures)
        stores = {path.split(b"/")[1] for path in made if path.startswith(b"lodestone/")}
        self.assertEqual(len(stores), len(self.files), stores)
        beside = sorted(path.name for path in self.folder.parent.iterdir())
        self.assertEqual(
            beside,
            ["base.blend", "files", "make.py", "night.files", "night.html"]
            + ["night.json", "night.jsonl"],
        )


if __name__ == "__main__":
    unittest.main()
