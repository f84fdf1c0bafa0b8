# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders the street at full detail and approximated, and writes picture strips and a report.

Run by samples/quickstart.sh with the system's Python:
    compare.py --blend build/samples/street.blend --out build/samples [--all [--write]]
        [--sky-occlusion 0]

Everything is rendered in one batch job: one reading of the .blend, the levels built when they are
stale, then for each camera a 16-sample reference, full detail and Pixel Error 0.5, 1, 2, 4 with the
antialiasing of final pictures, the masks of covered pixels, and the false-colored picture.
With --write the repository's pages show this run: the block of README.md that is between marks, its
picture strip, and samples/docs/results/street.md. With --sky-occlusion the sky's light is shaded by
so many rays a point instead of as many as the quality asks for (0: by none, so that only shapes
and materials differ), and --write shows it beside, in samples/docs/results/street_sky.md.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
STAGE = Path(os.environ.get("LODESTONE_STAGE", ROOT / "build/release/stage"))
ADDON = STAGE / "addons/lodestone"
sys.path.insert(0, str(ADDON))

import lodestone_native as native  # noqa: E402
from report import strip_block, with_strip, write_report  # noqa: E402
from strip import difference, make_strip  # noqa: E402

PIXEL_ERRORS = (0.5, 1.0, 2.0, 4.0)
CAMERAS = ("far", "middle", "near")
SIZE = (640, 360)


def name_of(pixel_error: float) -> str:
    return "full" if pixel_error == 0 else f"{pixel_error:g}px"


def views_of(camera: str, folder: Path, light: dict) -> list[dict]:
    """What batch.py is asked to render for one camera, under the light (options of a view)."""

    def view(name: str, pixel_error: float, **more) -> dict:
        out = str(folder / f"{camera}_{name}.png")
        return {
            "camera": camera,
            "pixel_error": pixel_error,
            "size": SIZE,
            "out": out,
            **light,
            **more,
        }

    views = [view("reference", 0.0, antialias="reference")]
    for pixel_error in (0.0, *PIXEL_ERRORS):
        views.append(view(name_of(pixel_error), pixel_error, antialias="final"))
        views.append(view(name_of(pixel_error) + "_mask", pixel_error, covered_only=True))
    views.append(view("1px_false", 1.0, false_color=True))
    return views


def render(blend: Path, folder: Path, cameras: tuple[str, ...], light: dict) -> dict:
    """Runs the batch job; returns its report."""
    views, report = folder / "views.json", folder / "batch.json"
    asked = [view for camera in cameras for view in views_of(camera, folder, light)]
    views.write_text(json.dumps(asked), "utf-8")
    command = ["/usr/bin/python3", str(ADDON / "batch.py"), "render", str(blend)]
    command += ["--store", str(folder / "store"), "--views", str(views), "--json", str(report)]
    done = subprocess.run(command, check=False)
    if done.returncode != 0:
        sys.exit(f"batch.py ended with exit code {done.returncode}; see {report}")
    return json.loads(report.read_text("utf-8"))


def merged_mask(a: Path, b: Path, out: Path) -> Path:
    """Covered pixels: where either picture has alpha."""
    first, second = native.image_read(str(a)), native.image_read(str(b))
    for i in range(3, len(first.pixels), 4):
        first.pixels[i] = max(first.pixels[i], second.pixels[i])
    native.image_write_png(str(out), first)
    return out


def compared(camera: str, folder: Path) -> dict:
    """{"full": {...}, "1px": {...}}: differences from the reference, on covered pixels."""
    full_mask = folder / f"{camera}_full_mask.png"
    out = {}
    for pixel_error in (0.0, *PIXEL_ERRORS):
        name = name_of(pixel_error)
        mask = merged_mask(
            full_mask,
            folder / f"{camera}_{name}_mask.png",
            folder / f"{camera}_{name}_covered.png",
        )
        found = native.image_compare(
            str(folder / f"{camera}_reference.png"), str(folder / f"{camera}_{name}.png"), str(mask)
        )
        out[name] = {
            "mean": found.mean,
            "p999": found.p999,
            "max": found.max,
            "ssim": found.ssim,
            "pixels": found.pixels,
        }
    return out


def legend() -> list:
    kinds = native.Kind
    entries = [(f"LOD {lod}", (kinds.MESH, lod)) for lod in (0, 1, 2, 3, 4, 5)]
    entries[-1] = ("LOD 5+", entries[-1][1])
    meshes = (kinds.MESH, kinds.ASSEMBLY)
    entries += [(kind.name, (kind, 0)) for kind in kinds if kind not in meshes]
    return [(word, native.povray_false_color(*key)) for word, key in entries]


def write_strip(camera: str, folder: Path) -> Path:
    def picture(name: str):
        return native.image_read(str(folder / f"{camera}_{name}.png"))

    full, one = picture("full"), picture("1px")
    panels = [
        (full, "FULL DETAIL"),
        (one, "PIXEL ERROR 1"),
        (picture("1px_false"), "WHICH REPRESENTATION"),
        (difference(full, one, 8.0), "DIFFERENCE X 8"),
    ]
    mask = picture("full_mask")
    path = folder / f"strip_{camera}.png"
    native.image_write_png(str(path), make_strip(native, panels, legend(), mask, 2))
    return path


def write_pages(folder: Path, light: dict) -> None:
    """The pages of the repository that show what this run measured."""
    sys.path.insert(0, str(ROOT / "tests" / "bench"))
    from benching import write_results

    report = json.loads((folder / "report.json").read_text("utf-8"))
    lines = (folder / "report.md").read_text("utf-8").splitlines()
    table = [line for line in lines[2:] if not line.startswith("![")]
    if light:
        title = f"The street, with sky occlusion {light['sky_occlusion']}"
        write_results(ROOT / "samples/docs/results/street_sky", title, table, report)
        return
    readme = ROOT / "README.md"
    readme.write_text(with_strip(readme.read_text("utf-8"), strip_block(report)), "utf-8")
    shutil.copy(folder / "strip_far.png", HERE / "strip_far.png")
    write_results(ROOT / "samples/docs/results/street", "The street", table, report)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--blend", type=Path, required=True)
    parser.add_argument("--out", type=Path, required=True, help="folder")
    parser.add_argument("--all", action="store_true", help="also the middle and near cameras")
    parser.add_argument("--write", action="store_true", help="with --all: into the pages")
    parser.add_argument("--sky-occlusion", type=int, metavar="RAYS", help="of all its pictures")
    options = parser.parse_args()
    if options.write and not options.all:
        parser.error("--write shows all cameras: it needs --all")
    folder = options.out.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    cameras = CAMERAS if options.all else CAMERAS[:1]
    light = {} if options.sky_occlusion is None else {"sky_occlusion": options.sky_occlusion}
    batch = render(options.blend.resolve(), folder, cameras, light)
    empty = native.povray_empty_bytes(*SIZE)
    differences = {camera: compared(camera, folder) for camera in cameras}
    strips = [write_strip(camera, folder) for camera in cameras]
    report = write_report(folder, batch, differences, empty)
    for strip in strips:
        print(f"picture strip: {strip}")
    print(f"report: {report}")
    if options.write:
        write_pages(folder, light)


if __name__ == "__main__":
    main()
