# SPDX-License-Identifier: GPL-3.0-or-later
"""What details of their own for reflections, shadows and indirect light save POV-Ray, what they
change, and the same for many lamps drawn as few.

    /usr/bin/python3 tests/bench/speed/bench_rays.py [--scenes mirror contact] [--rounds 5]
        [--png OUT] [--write]

Each scene of ray_scenes.py is drawn with one detail for all rays (off) and with each class's own
(on), in turns; with one class alone, and at twice the Pixel Error, once. Differences are of covered
pixels, in 255ths: to the originals with 16 samples in every pixel, and to "off". Prints a table and
writes JSON and, by --png, the sheet of pictures; no number makes it fail.
"""

import argparse
import os
import sys
from array import array
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from bench import benching  # noqa: E402
from bench.scenes import ray_scenes  # noqa: E402
from bench.speed.bench_lights import camera_of  # noqa: E402

ROOT = Path(__file__).resolve().parents[3]
STAGE = Path(os.environ.get("LODESTONE_STAGE") or ROOT / "build" / "release" / "stage")
NEAR = 3  # pixels from a contact
GOAL = 5.0  # of the largest difference there
BOUNCES = 2  # of light, in the scene that is lit by what its walls hand on
SHOWN = 8  # how many times the sheet's differences are enlarged
MARGIN = 4  # pixels between its pictures


class Bench:
    """One scene, built; its pictures by kind."""

    def __init__(self, native, name: str, size: list[int], folder: Path) -> None:
        self.native, self.size, self.folder = native, size, folder / name
        self.model, self.scene = ray_scenes.SCENES[name](native)
        # Figures of a row may stand for each other's group: stand-ins of groups are part of it.
        self.model.build(str(folder / "stores" / name))
        self.camera = camera_of(native, self.scene, size[0] / size[1])
        self.mask = self.covered()

    def kinds(self) -> dict[str, dict]:
        """What is compared, by name: arguments of draw()."""
        single = {
            one.name.lower(): int(one)
            for one in self.native.Rays
            if one != self.native.Rays.RADIOSITY or self.scene.radiosity
        }
        every = sum(single.values())
        found: dict[str, dict] = {"off": {"classes": 0}}
        found |= {name: {"classes": bit} for name, bit in single.items()}
        found["on"] = {"classes": every}
        if self.scene.lamps:
            for one in found.values():
                one["light_error"] = 0.0
            found["lights"] = {"classes": 0}
            found["on"] = {"classes": every}
        return found

    def draw(
        self,
        name: str,
        classes: int = 0,
        pixel_error: float = 1.0,
        antialias: int | None = None,
        light_error: float = -1.0,
        threads: int = 1,
        covered_only: bool = False,
    ) -> dict:
        """Renders folder/name/p.png."""
        native = self.native
        final = native.Antialias.FINAL if antialias is None else antialias
        options = native.PovrayOptions(
            antialias=final,
            light_error=light_error,
            threads=threads,
            covered_only=covered_only,
            bounces=BOUNCES if self.scene.radiosity else 0,
        )
        modifiers = native.Modifiers(ray_classes=classes) if classes else None
        view = native.View(self.camera, *self.size, pixel_error, modifiers=modifiers)
        out = self.folder / name
        start = sum(os.times()[:2])
        with native.Cut(self.model, view) as cut:
            native.povray_export(cut, str(out), options)
            export_s = sum(os.times()[:2]) - start
            seen = cut.summary().triangles
            met = [cut.rays(one).triangles for one in native.Rays if one & classes]
        ran = native.povray_run(str(out), "p.png", options)
        return {
            "export_cpu_s": export_s,
            "parse_cpu_s": ran.parse_cpu_s,
            "trace_cpu_s": ran.trace_cpu_s,
            "memory_bytes": ran.peak_bytes,
            "triangles": seen,
            "triangles_met": min(met, default=seen),  # by the class that meets fewest
        }

    def covered(self) -> str:
        """A picture whose alpha tells the covered pixels."""
        native = self.native
        self.draw(
            "mask",
            pixel_error=2.0,
            antialias=native.Antialias.OFF,
            light_error=0.0,
            covered_only=True,
        )
        return str(self.folder / "mask" / "p.png")

    def picture(self, name: str) -> numpy.ndarray:
        """[height][width][3], display-encoded, 0 to 255."""
        image = self.native.image_read(str(self.folder / name / "p.png"))
        linear = numpy.frombuffer(image.pixels, numpy.float32)
        linear = linear.reshape(image.height, image.width, 4)[:, :, :3].clip(0, 1)
        bent = 1.055 * numpy.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055
        return 255 * numpy.where(linear <= 0.0031308, 12.92 * linear, bent)

    def near_contact(self) -> numpy.ndarray | None:
        """Which pixels are within NEAR of one where things touch (also where that is hidden)."""
        if self.scene.contacts is None:
            return None
        camera, (width, height) = self.camera, self.size
        way = self.scene.contacts - numpy.array(camera.position)
        depth = way @ numpy.array(camera.direction)
        way, depth = way[depth > camera.near_clip], depth[depth > camera.near_clip]
        found = numpy.zeros((height, width), bool)
        across, up = numpy.array(camera.right), numpy.array(camera.up)
        x = numpy.floor((way @ across / (across @ across) / depth + 0.5) * width).astype(int)
        y = numpy.floor((0.5 - way @ up / (up @ up) / depth) * height).astype(int)
        for i in range(-NEAR, NEAR + 1):
            for j in range(-NEAR, NEAR + 1):
                a, b = x + i, y + j
                inside = (a >= 0) & (a < width) & (b >= 0) & (b < height)
                if i * i + j * j <= NEAR * NEAR:
                    found[b[inside], a[inside]] = True
        return found

    def differences(self, name: str, other: str) -> dict[str, float]:
        a, b = (str(self.folder / one / "p.png") for one in (name, other))
        found = self.native.image_compare(a, b, self.mask)
        return {"mean": 255 * found.mean, "max": 255 * found.max, "ssim": found.ssim}

    def run(self, rounds: int) -> dict:
        native = self.native
        kinds = self.kinds()
        timed = [kind for kind in ("off", "lights", "on") if kind in kinds]
        numbers: dict[str, list[dict]] = {kind: [] for kind in kinds}
        for _, kind in benching.turns(rounds, timed):
            numbers[kind].append(self.draw(kind, **kinds[kind]))
        for kind in kinds.keys() - set(timed):
            numbers[kind].append(self.draw(kind, **kinds[kind]))
        numbers["full"] = [
            self.draw(
                "full",
                pixel_error=0.0,
                antialias=native.Antialias.REFERENCE,
                light_error=0.0,
                threads=0,
            )
        ]
        for kind in ("off", "on"):
            asked = kinds[kind] | {"pixel_error": 2.0}
            numbers[f"{kind}, 2 px"] = [self.draw(f"{kind}, 2 px", **asked)]
        near = self.near_contact()
        out: dict[str, dict] = {}
        for kind, ones in numbers.items():
            base = "off, 2 px" if kind.endswith("2 px") else "off"
            out[kind] = {key: benching.spread([one[key] for one in ones]) for key in ones[0]}
            out[kind]["to_full"] = self.differences("full", kind)
            out[kind]["to_off"] = self.differences(base, kind)
            if near is not None:
                change = numpy.abs(self.picture(kind) - self.picture(base)).max(2)
                out[kind]["contact"] = float(change[near].max(initial=0))
        return out


def table(found: dict[str, dict]) -> list[str]:
    """A line for each scene and kind; those with rounds have the spread of their times."""
    lines = [
        "| scene | | parse, CPU s | trace, CPU s | memory, MB | triangles seen, met "
        "| to full: mean, SSIM | to off: mean, largest | near contact |",
        "|" + "---|" * 9,
    ]

    def seconds(one: dict) -> str:
        if one["min"] == one["max"]:
            return f"{one['median']:.2f}"
        return benching.cell(one)

    for name, kinds in found.items():
        for kind, one in kinds.items():
            full, off = one["to_full"], one["to_off"]
            cells = [
                name if kind == "off" else "",
                kind,
                seconds(one["parse_cpu_s"]),
                seconds(one["trace_cpu_s"]),
                f"{one['memory_bytes']['median'] / 1e6:.0f}",
                ", ".join(f"{one[key]['median']:,.0f}" for key in ("triangles", "triangles_met")),
                "" if kind == "full" else f"{full['mean']:.2f}, {full['ssim']:.4f}",
                "" if kind.startswith("off") else f"{off['mean']:.2f}, {off['max']:.0f}",
                f"{one['contact']:.0f}" if "contact" in one and kind != "full" else "",
            ]
            lines.append("| " + " | ".join(cells) + " |")
    return lines


def sheet(native, benches: list[Bench], out: Path) -> None:
    """A line for each scene: full, off, on, and eight times the difference of the latter two."""
    lines = []
    for bench in benches:
        full, off, on = (bench.picture(kind) for kind in ("full", "off", "on"))
        cells = [full, off, on, (SHOWN * numpy.abs(on - off)).clip(0, 255)]
        gap = numpy.full((len(full), MARGIN, 3), 255.0)
        row = [part for cell in cells for part in (cell, gap)][:-1]
        lines += [
            numpy.concatenate(row, axis=1),
            numpy.full((MARGIN, sum(part.shape[1] for part in row), 3), 255.0),
        ]
    shown = numpy.concatenate(lines[:-1]) / 255
    linear = numpy.where(shown <= 0.04045, shown / 12.92, ((shown + 0.055) / 1.055) ** 2.4)
    height, width, _ = linear.shape
    whole = numpy.concatenate([linear, numpy.ones((height, width, 1))], axis=2)
    pixels = array("f", whole.astype(numpy.float32).tobytes())
    native.image_write_png(str(out), native.Image(width, height, pixels))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    names = list(ray_scenes.SCENES)
    parser.add_argument("--scenes", nargs="+", default=names, choices=names)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--size", type=int, nargs=2, default=[240, 135], metavar=("W", "H"))
    parser.add_argument("--folder", type=Path, default=ROOT / "build" / "bench" / "rays")
    parser.add_argument("--png", type=Path, help="the sheet of pictures")
    benching.add_write(parser, "povray_export")
    options = parser.parse_args()
    addon = STAGE / "addons" / "lodestone"
    if not addon.is_dir():
        sys.exit("bench_rays.py: build the add-on first")
    if not ray_scenes.DATA.is_dir():
        sys.exit(f"bench_rays.py: skipped, there is no {ray_scenes.DATA} (LODESTONE_DATA)")
    sys.path.insert(0, str(addon))
    import lodestone_native as native

    busy = benching.load()
    benches, found = [], {}
    for name in options.scenes:
        bench = Bench(native, name, options.size, options.folder)
        benches.append(bench)
        found[bench.scene.name] = bench.run(options.rounds)
        print(f"{name} done", file=sys.stderr)
    told = benching.Told()
    told.tell(f"{options.size[0]} x {options.size[1]}; {benching.said(options.rounds, busy)}\n")
    told.tell("\n".join(table(found)))
    data = {"size": options.size, "scenes": found}
    benching.write(options.folder / "rays.json", busy, data)
    title = "Seven scenes with coarser shadows and reflections"
    page = benching.results_path(options, "rays")
    benching.write_results(page, title, told, {"load_before": busy, **data})
    if options.png:
        sheet(native, benches, options.png)


if __name__ == "__main__":
    main()
