# SPDX-License-Identifier: GPL-3.0-or-later
"""Stand-ins beside what they stand for: twelve groups, 64, 32, 16, 8 and 4 pixels large.

    /usr/bin/python3 tests/bench/sheets/sheet_replace.py [--only tree,crowd] [--png OUT.png]
        [--write]

A group's longest side has so many pixels. Each picture, by POV-Ray, shows many copies of it beside
each other, each turned in its own way and lying differently on the pixels. What is right is full
detail with 16 samples a pixel. Compared with it, with one sample a pixel: what Pixel Error 1 picks,
the whole group simplified as one mesh (Decimate's job, by our fast mode) to the memory that is
picked, and full detail; and what is picked once more with as many samples as full detail could pay
with the CPU seconds of tracing that it takes for one (two for every other pixel and the like, four
at most). Errors are mean absolute differences of display-encoded values over a middle grey, for
each pixel that what is right covers. Light is the sum of linear light, both with 16 samples.
"""

import argparse
import math
import statistics
import sys
import tempfile
from array import array
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from bench import benching  # noqa: E402
from bench.scenes.crowd_groups import GROUPS  # noqa: E402
from bench.scenes.mesh_materials import materials  # noqa: E402
from bench.sheets.sheet_measure import painted, parts_of, samples, seen  # noqa: E402
from bench.scenes.mesh_shapes import Filler  # noqa: E402

ROOT = Path(__file__).resolve().parents[3]
COPIES = {64: 2, 32: 4, 16: 6, 8: 8, 4: 12}  # along a side
GAP = 1.17  # between copies, over their diameter; no whole number of pixels
LEAST_TRIANGLES = 4
FEWEST_PARTS = 8  # of a pruned mesh
MOST_SAMPLES = 4
MOST_OFF = 0.03  # of the light
CELL = 64  # pixels of an enlarged picture of the sheet
GOLDEN = 2.399963


@dataclass
class Row:
    """What one group shows at one size."""

    name: str
    size: int
    kinds: dict[str, int] = field(default_factory=dict)  # of one copy
    main: str = ""
    triangles: int = 0
    full_triangles: int = 0
    bytes: int = 0
    light: float = 0
    errors: dict[str, float] = field(default_factory=dict)  # picked, paid, decimated, full
    cpu: float = 0  # of tracing, over that of full detail
    pictures: dict = field(default_factory=dict)  # right, sharp


class Shots:
    """Pictures of many copies of one object of a model."""

    def __init__(self, native, folder: Path, workers: ThreadPoolExecutor) -> None:
        self.native, self.folder, self.workers = native, folder, workers
        self.count = 0

    def prepare(self, model, item, radius: float, center, size: int, longest: float):
        """Fills `model` with copies around the origin; returns the view without its Pixel Error."""
        native, many = self.native, COPIES[size]
        turn, rise = 0.5, 0.3  # of the camera
        towards = (
            math.cos(rise) * math.cos(turn),
            math.cos(rise) * math.sin(turn),
            math.sin(rise),
        )
        right = (-math.sin(turn), math.cos(turn), 0.0)
        up = tuple(
            towards[(i + 1) % 3] * right[(i + 2) % 3] - towards[(i + 2) % 3] * right[(i + 1) % 3]
            for i in range(3)
        )
        cell = 2 * radius * GAP
        scene = model.add_group("copies", "copies")
        for row in range(many):
            for column in range(many):
                angle = GOLDEN * (row * many + column)
                c, s = math.cos(angle), math.sin(angle)
                a, b = (k - (many - 1) / 2 for k in (column, row))
                place = [cell * (a * r + b * u) for r, u in zip(right, up)]
                middle = (c * center[0] - s * center[1], s * center[0] + c * center[1], center[2])
                x, y, z = (p - m for p, m in zip(place, middle))
                model.add_placement(scene, item, (c, -s, 0, x, s, c, 0, y, 0, 0, 1, z), f"{angle}")
        model.set_root(scene)
        metre = size / longest
        pixels = max(8, round(cell * many * metre))
        width = pixels / metre
        camera = native.Camera(
            "sheet",
            True,
            tuple(4 * width * t for t in towards),
            tuple(-t for t in towards),
            tuple(width * r for r in right),
            tuple(width * u for u in up),
            0.01,
        )
        return camera, pixels

    def light_up(self, model) -> None:
        """A sun beside the viewer, high enough for shadows, and a sky."""
        native = self.native
        model.add_light(
            native.Light("sun", native.LightKind.SUN, power=3.0, direction=(-0.45, -0.75, -0.65))
        )
        model.set_world((0.3, 0.3, 0.32), transparent=True)

    def take(self, cut, sharp: bool) -> Future:
        """Renders later: (linear premultiplied pixels, CPU seconds of tracing). `sharp`:
        each pixel the mean of 16 samples; otherwise four of one sample where one belongs."""
        native = self.native
        self.count += 1
        folder = self.folder / f"{self.count}"
        folder.mkdir()
        view = cut.view
        if not sharp:
            cut.view = replace(view, width=2 * view.width, height=2 * view.height)
        antialias = native.Antialias.REFERENCE if sharp else native.Antialias.OFF
        options = native.PovrayOptions(antialias=antialias, threads=1)
        native.povray_export(cut, str(folder), options)
        cut.view = view

        def render() -> tuple:
            report = native.povray_run(str(folder), "picture.exr", options)
            image = native.image_read(str(folder / "picture.exr"))
            pixels = numpy.frombuffer(image.pixels, numpy.float32)
            return pixels.reshape(image.height, image.width, 4), report.trace_cpu_s

        return self.workers.submit(render)


class Sheet:
    def __init__(self, native, folder: Path, stores: Path, workers: ThreadPoolExecutor) -> None:
        self.native, self.folder, self.stores = native, folder, stores
        self.shots = Shots(native, folder, workers)

    def model_of(self, item):
        model = self.native.Model()
        root = Filler(self.native, model, materials(self.native, model)).put(item)
        model.set_root(root)
        return model, root

    def rows_of(self, name: str) -> list[tuple[Row, dict[str, Future]]]:
        """One a size; their pictures are still to come."""
        native, group = self.native, GROUPS[name]()
        joined = group.joined()
        sides = list(zip(*joined.points))
        longest = max(max(side) - min(side) for side in sides)
        store = self.stores / name.replace(" ", "_")
        out = []
        for size in COPIES:
            model, root = self.model_of(group)
            model.build(str(store))
            summary = model.object_summary(root)
            camera, pixels = self.shots.prepare(
                model, root, summary.radius, summary.center, size, longest
            )
            self.shots.light_up(model)
            row, copies = Row(name, size), COPIES[size] ** 2
            full = native.Cut(model, native.View(camera, pixels, pixels, 0.0))
            picked = native.Cut(model, native.View(camera, pixels, pixels, 1.0))
            row.full_triangles = full.summary().triangles // copies
            jobs = {
                "right": self.shots.take(full, True),
                "sharp": self.shots.take(picked, True),
                "full": self.shots.take(full, False),
                "picked": self.shots.take(picked, False),
            }
            self.describe(row, model, picked, copies, store, "glass" in joined.slots)
            if row.main != "original":
                whole, mesh = self.model_of(joined)
                costs = native.CostModel()
                own = row.bytes - costs.occurrence_bytes
                budget = max(LEAST_TRIANGLES, own // costs.triangle_bytes)
                whole.simplify(native.SimplifyOptions(triangles=budget))
                camera, pixels = self.shots.prepare(
                    whole, mesh, summary.radius, summary.center, size, longest
                )
                self.shots.light_up(whole)
                cut = native.Cut(whole, native.View(camera, pixels, pixels, 0.0))
                jobs["decimated"] = self.shots.take(cut, False)
            out.append((row, jobs))
        return out

    def describe(self, row: Row, model, cut, copies: int, store: Path, glass: bool) -> None:
        """What one copy is drawn by, and what that costs when nothing else uses it. Nothing with
        glass is judged by pictures."""
        native, shown, distinct = self.native, {}, set()
        for (item, lod), number in cut.counts().items():
            made = model.representation(item, lod)
            kind = native.Kind(made.kind).name.lower()
            if lod == 0:
                kind = "original"
            elif kind == "mesh":
                # Pictures have judged what has no larger error; no group has colors of vertices.
                kind, stored = "collapsed", store / "r" / f"{made.hash:016x}.glb"
                if painted(stored):
                    kind = "painted box"
                elif made.max_error == made.error and not glass:
                    parts = parts_of(stored)
                    kind = "pruned" if parts >= FEWEST_PARTS else "collapsed"
            elif made.max_error == made.error and kind != "composite":
                kind = f"{kind} by pictures"
            each = number / copies
            row.kinds[kind] = row.kinds.get(kind, 0) + round(each)
            row.triangles += round(made.triangles * each)
            row.bytes += round(native.CostModel().occurrence_bytes * each)
            if made.hash not in distinct or kind == "composite":
                row.bytes += made.bytes * (round(each) if kind == "composite" else 1)
            distinct.add(made.hash)
            area = each * model.object_summary(item).radius ** 2
            shown[kind] = shown.get(kind, 0) + area
        row.main = max(shown, key=lambda kind: shown[kind])

    def finish(self, row: Row, jobs: dict[str, Future]) -> None:
        done = {kind: job.result() for kind, job in jobs.items()}
        right, sharp = done["right"][0], done["sharp"][0]
        row.pictures = {"right": right, "sharp": sharp}
        covered = numpy.count_nonzero(right[:, :, 3] > 1 / 255)
        row.light = float(sharp[:, :, :3].sum() / right[:, :, :3].sum())
        row.cpu = done["sharp"][1] / max(done["right"][1], 1e-9)
        wanted = seen(right)

        def off(picture) -> float:
            return float(numpy.abs(seen(picture) - wanted).mean(axis=2).sum() / covered)

        for kind in ("picked", "decimated", "full"):
            if kind in done:
                row.errors[kind] = statistics.mean(off(p) for p in samples(done[kind][0], 1))
        # Between whole numbers of samples some pixels have one more.
        afforded = min(MOST_SAMPLES, max(1.0, 1 / max(row.cpu, 1e-9)))
        low = min(int(afforded), MOST_SAMPLES - 1)
        few, more = (
            statistics.mean(off(p) for p in samples(done["picked"][0], n)) for n in (low, low + 1)
        )
        row.errors["paid"] = few + (afforded - low) * (more - few)


def line_of(row: Row) -> str:
    kinds = ", ".join(f"{n} {kind}" for kind, n in row.kinds.items())
    errors = [row.errors.get(kind) for kind in ("picked", "paid", "decimated", "full")]
    told = ["" if error is None else f"{100 * error:.2f}" for error in errors]
    return (
        f"| {row.name} | {row.size} | {kinds} | {row.full_triangles:,} -> {row.triangles:,} "
        f"| {row.bytes / 1000:,.0f} | {row.light:.3f} | {' | '.join(told)} | {row.cpu:.2f} |"
    )


def verdict(rows: list[Row], told: benching.Told) -> None:
    told.tell("\n| kind | picked | light, mean (worst) | / decimated | / plain full | |")
    told.tell("|---|---|---|---|---|---|")
    for kind in sorted({row.main for row in rows} - {"original"}):
        own = [row for row in rows if row.main == kind]
        light = sum(row.light for row in own) / len(own)
        worst = max((row.light for row in own), key=lambda x: abs(x - 1))
        ratios = [
            statistics.geometric_mean(r.errors[ours] / r.errors[theirs] for r in own)
            for ours, theirs in (("picked", "decimated"), ("paid", "full"))
        ]
        good = abs(light - 1) <= MOST_OFF and all(ratio <= 1 for ratio in ratios)
        told.tell(
            f"| {kind} | {len(own)} | {light:.3f} ({worst:.3f}) | {ratios[0]:.3f} "
            f"| {ratios[1]:.3f} | {'holds' if good else 'does not hold'} |"
        )


def draw(native, rows: list[Row], out: Path) -> None:
    """A line a group; at each size what is right and what is picked, side by side."""
    lines = []
    for name in dict.fromkeys(row.name for row in rows):
        cells = []
        for row in (row for row in rows if row.name == name):
            for picture in (row.pictures["right"], row.pictures["sharp"]):
                shown = len(picture) // COPIES[row.size]
                at = numpy.arange(CELL) * shown // CELL
                # The first copy is the lowest on the left.
                cell = picture[len(picture) - shown + at][:, at].copy()
                cell[:, :, :3] += 1 - cell[:, :, 3:]
                cell[:, :, 3] = 1
                cells.append(cell)
        lines.append(numpy.concatenate(cells, axis=1))
    sheet = numpy.concatenate(lines).astype(numpy.float32)
    height, width, _ = sheet.shape
    pixels = array("f", sheet.tobytes())
    native.image_write_png(str(out), native.Image(width, height, pixels))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--png", type=Path, help="the sheet of pictures")
    parser.add_argument("--only", default=",".join(GROUPS), help="names of groups, by commas")
    parser.add_argument("--build", type=Path, default=ROOT / "build" / "release")
    parser.add_argument("--stores", type=Path, help="kept from run to run")
    benching.add_write(parser, "backend")
    options = parser.parse_args()
    sys.path.insert(0, str(options.build.resolve() / "stage" / "addons" / "lodestone"))
    import lodestone_native as native

    rows: list[Row] = []
    told, busy = benching.Told(), benching.load()
    with tempfile.TemporaryDirectory() as name, ThreadPoolExecutor(2) as workers:
        folder = Path(name)
        stores = options.stores or folder / "stores"
        stores.mkdir(parents=True, exist_ok=True)
        (folder / "pictures").mkdir()
        sheet = Sheet(native, folder / "pictures", stores, workers)
        told.tell(
            "| group | px | picked | triangles | kB | light | picked | paid | decimated | full "
            "| CPU |\n|---|---|---|---|---|---|---|---|---|---|---|"
        )
        waiting: list = []

        def tell() -> None:
            for row, jobs in waiting:
                sheet.finish(row, jobs)
                rows.append(row)
                told.tell(line_of(row))

        for name in options.only.split(","):
            coming = sheet.rows_of(name)  # while those before are drawn
            tell()
            waiting = coming
        tell()
        verdict(rows, told)
        page = benching.results_path(options, "stand_ins")
        data = {"load_before": busy, "lines": list(told)}
        benching.write_results(page, "Stand-ins at 64 to 4 pixels", told, data)
        if options.png:
            draw(native, rows, options.png)


if __name__ == "__main__":
    main()
