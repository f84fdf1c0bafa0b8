# SPDX-License-Identifier: GPL-3.0-or-later
"""Stand-ins beside what they stand for: a sheet of pictures 64, 32, 16, 8 and 4 pixels high.

    /usr/bin/python3 tests/bench/sheet_replace.py OUT.png [--build build/release]

A tree of 2,800 leaf quads, a crowd of 80 figures and a bookcase, made here. Each pair of rows is
the 16-sample picture at full detail, and the level that Pixel Error 1 picks with the samples of
final pictures; all are enlarged to the same height. Prints what was picked, its brightness over
that of the full picture, and what both cost POV-Ray.
"""

import argparse
import json
import math
import random
import subprocess
import sys
import tempfile
from array import array
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HEIGHTS = (64, 32, 16, 8, 4)
CELL = 128  # pixels of an enlarged picture
GAP = 2
FILL = 0.8  # of the picture is the object


class Obj:
    """Text of a Wavefront file, Z up."""

    def __init__(self) -> None:
        self.lines = ["mtllib colors.mtl"]
        self.count = 0

    def begin(self, name: str, material: str) -> None:
        self.lines += [f"o {name}", f"usemtl {material}"]

    def use(self, material: str) -> None:
        self.lines.append(f"usemtl {material}")

    def faces(self, points: list, faces: list) -> None:
        self.lines += [f"v {x:.5f} {y:.5f} {z:.5f}" for x, y, z in points]
        for face in faces:
            self.lines.append("f " + " ".join(str(self.count + i + 1) for i in face))
        self.count += len(points)

    def box(self, low: tuple, high: tuple) -> None:
        points = [
            (x, y, z)
            for z in (low[2], high[2])
            for x, y in ((low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1]))
        ]
        sides = [(i, (i + 1) % 4, (i + 1) % 4 + 4, i + 4) for i in range(4)]
        self.faces(points, [(3, 2, 1, 0), (4, 5, 6, 7), *sides])

    def ball(self, center: tuple, radii: tuple, rows: int = 10) -> None:
        points, faces, around = [], [], 2 * rows
        for j in range(rows + 1):
            polar = math.pi * j / rows
            for i in range(around):
                turn = 2 * math.pi * i / around
                unit = (
                    math.sin(polar) * math.cos(turn),
                    math.sin(polar) * math.sin(turn),
                    math.cos(polar),
                )
                points.append(tuple(c + r * u for c, r, u in zip(center, radii, unit)))
        for j in range(rows):
            for i in range(around):
                a, b = j * around + i, j * around + (i + 1) % around
                faces.append((a, a + around, b + around, b))
        self.faces(points, faces)


def tree() -> Obj:
    rng, out = random.Random(5), Obj()
    out.begin("tree", "bark")
    rings = [(0.16 * (1 - j / 20), 5.0 * j / 16) for j in range(17)]
    points = [
        (r * math.cos(math.pi * i / 6), r * math.sin(math.pi * i / 6), z)
        for r, z in rings
        for i in range(12)
    ]
    corners = [(j * 12 + i, j * 12 + (i + 1) % 12) for j in range(16) for i in range(12)]
    out.faces(points, [(a, b, b + 12, a + 12) for a, b in corners])
    out.use("leaf")

    def unit() -> list:
        v = [rng.gauss(0, 1) for _ in range(3)]
        return [x / math.hypot(*v) for x in v]

    for _ in range(2800):
        radius, way = 1.8 * rng.random() ** 0.45, unit()
        place = [c + radius * x for c, x in zip((0, 0, 4.2), way)]
        u, w = unit(), unit()
        along = sum(a * b for a, b in zip(u, w))
        w = [b - along * a for a, b in zip(u, w)]
        size = math.hypot(*w)
        ends = ((u, 0.15), (w, 0.1 / size), (u, -0.15), (w, -0.1 / size))
        leaf = [tuple(p + s * x for p, x in zip(place, way)) for way, s in ends]
        out.faces(leaf, [(0, 1, 2, 3)])
    return out


def crowd() -> Obj:
    rng, out = random.Random(8), Obj()
    for number in range(80):
        x, y = 1.1 * (number % 10) + rng.uniform(-0.3, 0.3), 1.1 * (number // 10)
        y += rng.uniform(-0.3, 0.3)
        tall = rng.uniform(0.9, 1.1)
        out.begin(f"figure {number}", rng.choice(("red", "blue", "green")))
        out.ball((x, y, 1.05 * tall), (0.25, 0.2, 0.42 * tall))
        out.use("dark")
        for side in (-0.12, 0.12):
            out.ball((x + side, y, 0.4 * tall), (0.1, 0.12, 0.4 * tall), 8)
        out.use("skin")
        out.ball((x, y, 1.62 * tall), (0.12, 0.13, 0.16), 8)
    return out


def bookcase() -> Obj:
    rng, out = random.Random(2), Obj()
    out.begin("case", "bark")
    for shelf in range(5):
        out.box((0, 0, 0.5 * shelf), (1.6, 0.4, 0.5 * shelf + 0.04))
    for x in (0, 1.56):
        out.box((x, 0, 0), (x + 0.04, 0.4, 2.04))
    number = 0
    for shelf in range(4):
        x = 0.06
        while x < 1.5:
            wide = rng.uniform(0.02, 0.05)
            out.begin(f"book {number}", rng.choice(("red", "blue", "green", "skin")))
            low = 0.5 * shelf + 0.04
            out.box((x, 0.05, low), (x + wide, 0.3, low + rng.uniform(0.25, 0.42)))
            x += wide + 0.003
            number += 1
    return out


MODELS = {"tree": tree, "crowd": crowd, "bookcase": bookcase}
COLORS = {
    "bark": (0.2, 0.1, 0.05),
    "leaf": (0.1, 0.35, 0.05),
    "red": (0.6, 0.08, 0.05),
    "blue": (0.06, 0.12, 0.5),
    "green": (0.1, 0.4, 0.12),
    "dark": (0.03, 0.03, 0.04),
    "skin": (0.6, 0.4, 0.3),
}
VIEWS = {"tree": (3.2, 6.0), "crowd": (0.9, 11.5), "bookcase": (1.0, 2.3)}  # middle, extent
CENTERS = {"tree": (0, 0), "crowd": (5, 4), "bookcase": (0.8, 0.2)}


def run(command: list, **more) -> subprocess.CompletedProcess:
    done = subprocess.run([str(part) for part in command], capture_output=True, **more)
    if done.returncode != 0:
        sys.exit(f"sheet_replace.py: {done.stderr.decode(errors='replace').strip()}")
    return done


def picture(command: Path, store: Path, name: str, height: int, detail: float, out: Path) -> dict:
    """Renders so that the model is `height` pixels high; returns the report."""
    middle, extent = VIEWS[name]
    x, y = CENTERS[name]
    far = extent / FILL / (2 * math.tan(math.radians(10)))
    side = round(height / FILL)
    eye = (x + 0.45 * far, y - 0.85 * far, middle + 0.28 * far)
    report = out.with_suffix(".json")
    run(
        [command, "povray", store, "--out", out, "--pixel-error", detail]
        + ["--size", f"{side}x{side}", "--angle-deg", 20, "--json", report]
        + [f"--eye={eye[0]},{eye[1]},{eye[2]}", f"--look-at={x},{y},{middle}"]
        + ["--antialias", "reference" if detail == 0 else "final"]
    )
    return json.loads(report.read_text("utf-8"))


def enlarged(image, side: int) -> list[array]:
    """Rows of a square picture as large as a cell, without mixing pixels."""
    rows = []
    for y in range(side):
        row = array("f")
        source = y * image.height // side * image.width
        for x in range(side):
            at = 4 * (source + x * image.width // side)
            row.extend(image.pixels[at : at + 3])
            row.append(1.0)
        rows.append(row)
    return rows


def brightness(image, empty: float = 0.0) -> float:
    return sum(sum(image.pixels[c::4]) for c in range(3)) - empty


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("--build", type=Path, default=ROOT / "build" / "release")
    options = parser.parse_args()
    command = options.build.resolve() / "lodestone"
    sys.path.insert(0, str(options.build.resolve() / "stage" / "addons" / "lodestone"))
    import lodestone_native as native

    width = len(HEIGHTS) * (CELL + GAP) - GAP
    rows: list[array] = []
    with tempfile.TemporaryDirectory() as folder_name:
        folder = Path(folder_name)
        text = "".join(f"newmtl {n}\nKd {c[0]} {c[1]} {c[2]}\n" for n, c in COLORS.items())
        (folder / "colors.mtl").write_text(text, "utf-8")
        for name, make in MODELS.items():
            source, store = folder / f"{name}.obj", folder / name
            source.write_text("\n".join(make().lines) + "\n", "utf-8")
            run([command, "build", source, store])
            pairs: list[list] = [[], []]
            for height in HEIGHTS:
                reports = []
                for kind, detail in enumerate((0, 1)):
                    out = folder / f"{name}_{height}_{detail}.png"
                    reports.append(picture(command, store, name, height, detail, out))
                    pairs[kind].append(native.image_read(str(out)))
                kinds = {k: n for k, n in reports[1]["cut"]["kinds"].items() if n}
                full, ours = brightness(pairs[0][-1]), brightness(pairs[1][-1])
                print(
                    f"| {name} | {height} | "
                    + ", ".join(f"{n} {k}" for k, n in kinds.items())
                    + f" | {reports[0]['cut']['triangles']:,} / {reports[1]['cut']['triangles']:,}"
                    + f" | {reports[0]['cut']['bytes'] / 1e6:.2f} /"
                    + f" {reports[1]['cut']['bytes'] / 1e6:.3f} | {ours / full:.3f} |"
                )
            for images in pairs:
                cells = [enlarged(image, CELL) for image in images]
                for y in range(CELL):
                    row = array("f")
                    for cell in cells:
                        row.extend(cell[y])
                        if cell is not cells[-1]:
                            row.extend((1.0, 1.0, 1.0, 1.0) * GAP)
                    rows.append(row)
                rows += [array("f", (1.0,) * 4 * width)] * GAP
    pixels = array("f")
    for row in rows[:-GAP]:
        pixels.extend(row)
    sheet = type(pairs[0][0])(width, len(rows) - GAP, pixels)
    native.image_write_png(str(options.out), sheet)


if __name__ == "__main__":
    main()
