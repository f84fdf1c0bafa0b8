# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards what stand-ins are for (dissertation, Figure 2.15): where a pixel holds hundreds of
leaves, one ray to a stand-in brings a picture nearer to the truth in a second than rays to the
leaves do."""

import math
import os
import random
import re
import shutil
import struct
import subprocess
import tempfile
import unittest
import zlib
from pathlib import Path

COMMAND = os.environ.get("LODESTONE_COMMAND", "build/release/lodestone")
LEAVES = 5000
TRUTH = 16  # rays along the side of a pixel of it: 256 in all
APART = 8.9  # metres between trees


def tree():
    """Text of a Wavefront file, Z up: a trunk of four quads and a round crown of leaf quads."""
    rng = random.Random(11)
    points, faces = [], []

    def unit():
        v = [rng.gauss(0, 1) for _ in range(3)]
        return [x / math.hypot(*v) for x in v]

    def add(corners):
        faces.append([len(points) + i + 1 for i in range(4)])
        points.extend(corners)

    for i in range(4):
        a, b = math.pi * i / 2, math.pi * (i + 1) / 2
        ring = [(0.2 * math.cos(t), 0.2 * math.sin(t)) for t in (a, b)]
        add([(*ring[0], 0.0), (*ring[1], 0.0), (*ring[1], 4.0), (*ring[0], 4.0)])
    trunk = len(faces)
    for _ in range(LEAVES):
        place = [c + 2.0 * rng.random() ** 0.4 * x for c, x in zip((0, 0, 4.5), unit())]
        u, w = unit(), unit()
        along = sum(a * b for a, b in zip(u, w))
        w = [b - along * a for a, b in zip(u, w)]
        length = math.hypot(*w)
        ends = ((u, 0.12), (w, 0.07 / length), (u, -0.12), (w, -0.07 / length))
        add([tuple(p + s * x for p, x in zip(place, way)) for way, s in ends])
    lines = ["mtllib tree.mtl", "o tree"] + [f"v {x:.5f} {y:.5f} {z:.5f}" for x, y, z in points]
    for i, face in enumerate(faces):
        lines += [f"usemtl {'bark' if i < trunk else 'leaf'}"] if i in (0, trunk) else []
        lines.append("f " + " ".join(map(str, face)))
    return "\n".join(lines) + "\n"


def light_of(path):
    """All numbers of a 16-bit RGB(A) PNG, 0...1, without alpha."""
    data, at, packed = path.read_bytes(), 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + length]
        if kind == b"IHDR":
            width, height, depth, color = struct.unpack(">IIBB", body[:10])
        packed += body if kind == b"IDAT" else b""
        at += length + 12
    channels = {2: 3, 6: 4}[color]
    assert depth == 16
    step = 2 * channels
    raw, stride, out = zlib.decompress(packed), step * width, []
    last = bytearray(stride)
    for y in range(height):
        method, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1 :][:stride])
        for i in range(stride):
            left = line[i - step] if i >= step else 0
            corner = last[i - step] if i >= step else 0
            up = last[i]
            guess = left + up - corner
            nearest = min((abs(guess - v), n) for n, v in enumerate((left, up, corner)))[1]
            add = (0, left, up, (left + up) // 2, (left, up, corner)[nearest])[method]
            line[i] = (line[i] + add) & 255
        last = line
        numbers = struct.unpack(f">{width * channels}H", line)
        out += [v / 65535 for i in range(0, len(numbers), channels) for v in numbers[i : i + 3]]
    return out


@unittest.skipIf(shutil.which("povray") is None, "no POV-Ray")
class TreeOfLeaves(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        cls.store = cls.folder / "store"
        (cls.folder / "tree.obj").write_text(tree())
        (cls.folder / "tree.mtl").write_text(
            "newmtl bark\nKd 0.2 0.1 0.05\nnewmtl leaf\nKd 0.1 0.35 0.05\n"
        )
        cls.command("build", cls.folder / "tree.obj", cls.store)

    @classmethod
    def command(cls, *arguments):
        done = subprocess.run(
            [COMMAND, *map(str, arguments)], capture_output=True, text=True, timeout=120
        )
        assert done.returncode == 0, done.stderr

    def grove(self, pixels, side, pixel_error):
        """The folder of a scene: side x side turned trees, each in a square of so many pixels."""
        folder = self.folder / f"{pixels}_{pixel_error}"
        self.command(
            *("povray", self.store, "--out", self.folder / "one.png", "--scene", folder),
            *("--eye", "97.2,23.3,20", "--look-at", "0,0,3.5", "--angle-deg", "5"),
            *("--size", f"{pixels}x{pixels}", "--antialias", "off", "--pixel-error", pixel_error),
        )
        text = (folder / "scene.pov").read_text()
        drawn = re.search(r"object\{(LDS_R_\w+) matrix.*", text)
        right, up = (re.search(rf"{word} <(.*)>", text)[1] for word in ("right", "up"))
        middle = (side - 1) / 2
        trees = (
            f"#for (I, 0, {side - 1}) #for (J, 0, {side - 1})\n"
            f"object{{{drawn[1]} rotate z * 137.5 * (I * {side} + J)\n"
            f"translate {APART} * ((I - {middle}) * vnormalize(<{right}>)"
            f" + (J - {middle}) * vnormalize(<{up}>))}}\n#end #end\n"
        )
        text = text.replace(drawn[0], trees)
        text = re.sub(r"(right|up) (<.*>)", rf"\1 {side} * \2", text)
        (folder / "grove.pov").write_text(text)
        return folder

    def rendered(self, folder, size, rays):
        """With rays x rays to a pixel; the light, CPU seconds of reading and tracing, and how often
        POV-Ray asked whether a ray meets a shape or a box around some."""
        many = ["+A0.0", "+AM1", f"+R{rays}", "-J", "Antialias_Gamma=1"] if rays > 1 else ["-A"]
        done = subprocess.run(
            ["povray", "+Igrove.pov", "+Oout.png", f"+W{size}", f"+H{size}", "-D", "+FN16"]
            + ["+WT1", "File_Gamma=1.0", *many],
            cwd=folder,
            capture_output=True,
            text=True,
            timeout=120,
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        seconds = re.findall(r"Time:.*\n\s*using \d+ thread.* with ([\d.]+) CPU", done.stderr)
        tests = re.findall(r"^\S.*?\s{2,}(\d+) +\d+ +[\d.]+$", done.stderr, re.MULTILINE)
        self.assertGreater(len(tests), 1, done.stderr)
        return (
            light_of(folder / "out.png"),
            max(0.001, sum(map(float, seconds))),
            sum(map(int, tests)),
        )

    def compared(self, pixels, side):
        """Mean square errors, CPU seconds and tests of 1 and 64 rays to the leaves, and of 1 to the
        stand-in."""
        leaves, stand_in = (self.grove(pixels, side, error) for error in (0, 1))
        size = pixels * side
        truth = self.rendered(leaves, size, TRUTH)[0]
        out = {}
        for name, folder, rays in (("1", leaves, 1), ("64", leaves, 8), ("stand-in", stand_in, 1)):
            light, seconds, tests = self.rendered(folder, size, rays)
            if rays == 1:  # short: the least of three counts
                seconds = min([seconds] + [self.rendered(folder, size, 1)[1] for _ in range(2)])
            off = sum((a - b) ** 2 for a, b in zip(light, truth)) / len(truth)
            print(
                f"{pixels} px, {name}: mean square {off:.6f}, {seconds:.3f} CPU s, {tests} tests",
                end="; ",
            )
            out[name] = (off, seconds, tests)
        return out

    def test_one_ray_to_a_stand_in_of_16_pixels_is_nearer_to_the_truth_than_one_to_the_leaves(self):
        found = self.compared(16, 5)
        self.assertLess(found["stand-in"][0], 0.75 * found["1"][0])
        self.assertLess(found["stand-in"][1], found["1"][1])

    def test_where_a_pixel_holds_hundreds_of_leaves_a_ray_to_the_stand_in_is_worth_most(self):
        found = self.compared(6, 16)
        # What as many tests would bring the mean square error down to. Seconds are hundredths here,
        # and most of them are for reading 256 copies: another machine has others.
        off = {name: error * tests for name, (error, _, tests) in found.items()}
        self.assertLess(off["stand-in"], 0.75 * off["1"])
        self.assertLess(off["stand-in"], 0.75 * off["64"])
        self.assertLess(found["stand-in"][0], found["1"][0])


if __name__ == "__main__":
    unittest.main()
