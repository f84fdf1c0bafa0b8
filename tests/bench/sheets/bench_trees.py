# SPDX-License-Identifier: GPL-3.0-or-later
"""Trees from near to far: full detail, ours at 1 and 4 px, our cards, and the artists' level.

    /usr/bin/python3 tests/bench/sheets/bench_trees.py [--trees pinetree_b ...] [--cache FOLDER]
        [--write]

Eight trees of three tracks of SuperTuxKart (the Debian package supertuxkart-data, fetched into the
cache, and LODESTONE_TOOLS/stk_scenes), each with the coarsest level that its artists made. A tree
is drawn 200, 100, 50, 25 and 12 pixels high, with 16 samples a pixel, under one sun and a gray sky,
without a background, so that alpha is what it covers. Beside full detail: covered area over full
detail's, difference of the mean color (the worst channel, of 255) and SSIM over the pixels of
either's outline. The same from four sides and from above at 60 degrees, 50 pixels high: mean and
worst. Cards (with whatever has none, as the trunk) and the artists' level are drawn whatever their
error. *Outlines* has all triangles at a Pixel Error of 0.01: what is left is how masks are cut out
for any Pixel Error but 0. Prints Markdown and writes JSON; the sheet of pictures is
build/bench/trees/sheet.png. What is missing is skipped with a sentence; no number makes it fail.
"""

import argparse
import json
import math
import shutil
import statistics
import subprocess
import sys
from array import array
from pathlib import Path
from typing import NamedTuple

import numpy
from PIL import Image

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from bench import benching  # noqa: E402
from bench.peers import bench_real  # noqa: E402

ROOT = benching.ROOT
COMMAND = ROOT / "build" / "release" / "lodestone"
INSIDE = Path(__file__).with_name("bench_trees_blender.py")
# Track, and the trees of it. Cards were made while looking at those of black_forest alone.
TREES = {
    "black_forest": (
        "stklib_pinetree_b/stklib_pinetree_b", "stklib_autumnBirch_a/stklib_autumnBirch_a",
        "stklib_autumnTree_c/stklib_autumnTree_c", "stklib_autumnWillow_a/stklib_autumnWillow_a",
        "black_forest/ekasia_tree",
    ),
    "cocoa_temple": (
        "stklib_palmTree_a/palmTree", "stklib_tropicalPlant_a/tropicalPlant_a",
    ),
    "zengarden": ("zengarden/sakuraPine",),
}  # fmt: skip
SIZES = (200, 100, 50, 25, 12)
SIDES_AT = 50
DISTANCE = 20.0  # of the eye, in heights of the tree
AROUND = 1.25  # the picture's side over the tree's height
CELL = 72  # pixels of the sheet
COLORS = 256  # of the sheet
SUN = {"angle": 0.0, "color": [1, 1, 1], "direction": [-0.35, 0.55, -0.76], "kind": "sun"}
SUN |= {"name": "Sun", "position": [0, 0, 0], "power": 3.0, "shadow": True}
SKY = 0.25  # gray


class Kind(NamedTuple):
    """A way to draw a tree: the store it comes from, the Pixel Error, its name in tables."""

    store: str
    pixel_error: float
    title: str


KINDS = {
    "full": Kind("ours", 0, "full"),
    "outlines": Kind("ours", 0.01, "outlines"),
    "ours": Kind("ours", 1, "ours, 1 px"),
    "ours 4": Kind("ours", 4, "ours, 4 px"),
    "cards": Kind("cards", 0, "cards"),
    "artists": Kind("artists", 0, "artists'"),
}
SHOWN = ("full", "ours", "ours 4", "cards", "artists")  # lines of the sheet
FROM_ASIDE = ("ours", "cards", "artists")


class Tree(NamedTuple):
    """A tree's stores by name, its box, and the error of its cards. Metres."""

    name: str
    stores: dict[str, Path]
    low: numpy.ndarray
    high: numpy.ndarray
    card_error: float  # infinite: it has no cards

    def has(self, kind: str) -> bool:
        return KINDS[kind].store in self.stores


class Side(NamedTuple):
    """Where one looks from, in degrees."""

    turn: float
    rise: float


NEAR = Side(30, 12)
SIDES = (*(Side(90.0 * i + 10, 12) for i in range(4)), Side(30, 60))


def run(*command: object) -> str:
    """What a command prints. Raises bench_real.Missing."""
    done = subprocess.run(
        [str(word) for word in command], capture_output=True, text=True, check=False
    )
    if done.returncode not in (0, 3):
        raise bench_real.Missing(f"{Path(str(command[0])).name} failed: {done.stderr[-300:]}")
    return done.stdout


def track_of(name: str, scenes: bench_real.Scenes) -> Path:
    """The .blend of a track with its artists' levels. Raises bench_real.Missing."""
    path = scenes.cache / "trees" / name / f"{name}.blend"
    if not path.is_file():
        maker = bench_real.TOOLS / "stk_scenes" / "stk_scenes.py"
        if not maker.is_file():
            raise bench_real.Missing(f"there is no {maker}")
        path.parent.mkdir(parents=True, exist_ok=True)
        inside = ["blender", "-b", "--python-exit-code", "1", "-P", maker, "--"]
        run(*inside, scenes.game(), name, path, "--all-lods")
    return path


def described(store: Path) -> dict:
    """What a store tells of its model."""
    tileset = json.loads((store / "tileset.json").read_text("utf-8"))
    return tileset["asset"]["extras"]["lodestone"]


def describe(store: Path, model: dict) -> None:
    """Lets a store tell that, with our sun and sky and a clear background."""
    path = store / "tileset.json"
    tileset = json.loads(path.read_text("utf-8"))
    clear = {"lights": [SUN], "world": {"color": [SKY] * 3, "transparent": True}}
    tileset["asset"]["extras"]["lodestone"] = model | clear
    path.write_text(json.dumps(tileset), "utf-8")


def built(model: Path, store: Path) -> Path:
    """A store of a model. Raises bench_real.Missing."""
    shutil.rmtree(store, ignore_errors=True)
    run(COMMAND, "build", model, store)
    describe(store, described(store))
    return store


def cards_of(model: dict, thing: dict) -> list[dict]:
    """The cards among the levels of an object: none, or one."""
    names = [material["name"] for material in model["materials"]]
    return [
        level
        for level in thing["representations"]
        if "cards" in (names[number] for number in level.get("materials", ()))
    ]


def with_cards_alone(store: Path, out: Path) -> tuple[Path, float] | None:
    """A copy of a store with cards for what has some, all else as it is; and their error."""
    model = described(store)
    errors = []
    for thing in model["objects"]:
        cards = cards_of(model, thing)
        errors += [level["error"] for level in cards]
        finest = thing["representations"][0]
        level = cards[0] if cards else finest
        exact = {"error": 0.0, "max_error": 0.0, "shape": finest["shape"]}
        thing["representations"] = [level | exact]
    if not errors:
        return None
    shutil.rmtree(out, ignore_errors=True)
    shutil.copytree(store, out)
    describe(out, model)
    return out, max(errors)


def box_of(store: Path) -> tuple[numpy.ndarray, numpy.ndarray]:
    """The box around a store's model."""
    model = described(store)
    finest = model["objects"][model["root"]]["representations"][0]
    return numpy.array(finest["low"]), numpy.array(finest["high"])


def trees_of(track: str, wanted: list[str], scenes: bench_real.Scenes, out: Path) -> list[Tree]:
    """The wanted trees of a track, with their levels built. Raises bench_real.Missing."""
    names = [name for name in TREES[track] if not wanted or name.split("/")[-1] in wanted]
    if not names:
        return []
    folder = scenes.cache / "trees" / track
    if not all((folder / f"{name.split('/')[-1]}_artists.glb").is_file() for name in names):
        blend = track_of(track, scenes)
        start = ["blender", "-b", blend, "--python-exit-code", "1", "--python", INSIDE, "--"]
        run(*start, folder, *TREES[track])
    trees = []
    for name in (one.split("/")[-1] for one in names):
        stores = {
            "ours": built(folder / f"{name}_full.glb", out / name / "ours"),
            "artists": built(folder / f"{name}_artists.glb", out / name / "artists"),
        }
        cards = with_cards_alone(stores["ours"], out / name / "cards")
        if cards:
            stores["cards"] = cards[0]
        box = box_of(stores["ours"])
        trees.append(Tree(name, stores, *box, cards[1] if cards else math.inf))
    return trees


class Picture(NamedTuple):
    """A picture, and what was drawn for it."""

    path: Path
    triangles: int
    pixels: numpy.ndarray  # [h][w][4]: linear, of what is covered; the share that is covered

    @property
    def area(self) -> float:
        """Pixels that it covers."""
        return float(self.pixels[..., 3].sum())

    @property
    def color(self) -> numpy.ndarray:
        """The mean color of what is covered, displayed, of 255."""
        return displayed(self.pixels[..., :3].sum(axis=(0, 1)) / max(self.area, 1e-6))

    @property
    def on_sky(self) -> numpy.ndarray:
        """[h][w][3]: linear, before the sky."""
        return self.pixels[..., :3] + SKY * (1 - self.pixels[..., 3:])


def displayed(linear: numpy.ndarray) -> numpy.ndarray:
    """The sRGB values of linear ones, of 255."""
    linear = linear.clip(0, 1)
    curve = 1.055 * numpy.maximum(linear, 0.0031308) ** (1 / 2.4) - 0.055
    return 255 * numpy.where(linear <= 0.0031308, 12.92 * linear, curve)


class Bench:
    """Draws trees."""

    def __init__(self, native, out: Path) -> None:
        self.native, self.out = native, out

    def picture(self, tree: Tree, name: str, size: int, side: Side) -> Picture:
        """A picture of a tree that is `size` pixels high."""
        kind = KINDS[name]
        height = float(tree.high[2] - tree.low[2])
        middle = 0.5 * (tree.low + tree.high)
        turn, rise = math.radians(side.turn), math.radians(side.rise)
        away = numpy.array(
            [math.cos(rise) * math.cos(turn), math.cos(rise) * math.sin(turn), math.sin(rise)]
        )
        eye = middle + DISTANCE * height * away
        frame = round(AROUND * size)
        angle = math.degrees(2 * math.atan(0.5 * AROUND / DISTANCE))
        path = self.out / tree.name / f"{name}_{size}_{side.turn:.0f}_{side.rise:.0f}.png"
        report = path.with_suffix(".json")
        run(
            COMMAND, "povray", tree.stores[kind.store], "--out", path, "--json", report,
            "--eye", ",".join(f"{one:.6f}" for one in eye),
            "--look-at", ",".join(f"{one:.6f}" for one in middle),
            "--angle-deg", f"{angle:.6f}", "--size", f"{frame}x{frame}",
            "--pixel-error", kind.pixel_error, "--antialias", "reference", "--filter-size", 0,
        )  # fmt: skip
        told = json.loads(report.read_text("utf-8"))
        image = self.native.image_read(str(path))
        pixels = numpy.array(image.pixels).reshape(image.height, image.width, 4)
        return Picture(path, told["cut"]["triangles"], pixels)

    def written(self, pixels: numpy.ndarray, name: str) -> str:
        """The path of a picture of [h][w][3] linear values, or of a mask of [h][w]."""
        path = self.out / f"{name}.png"
        height, width = pixels.shape[:2]
        whole = numpy.ones((height, width, 4), numpy.float32)
        whole[...] = pixels[..., None] if pixels.ndim == 2 else 1
        if pixels.ndim == 3:
            whole[..., :3] = pixels
        self.native.image_write_png(
            str(path), self.native.Image(width, height, array("f", whole.tobytes()))
        )
        return str(path)

    def differences(self, full: Picture, one: Picture) -> dict[str, float]:
        """What a picture is beside that of full detail."""
        mask = numpy.maximum(full.pixels[..., 3], one.pixels[..., 3])
        off = self.native.image_compare(
            self.written(full.on_sky, "full"),
            self.written(one.on_sky, "one"),
            self.written(mask, "mask"),
        )
        return {
            "triangles": one.triangles,
            "area": one.area / max(full.area, 1e-6),
            "color": float(numpy.abs(one.color - full.color).max()),
            "ssim": off.ssim,
        }

    def sizes(self, tree: Tree) -> tuple[list[dict], list[list[numpy.ndarray]]]:
        """What each kind is at each size, and the pictures of the sheet by kind and size."""
        rows: list[dict] = []
        cells: list[list[numpy.ndarray]] = [[] for _ in SHOWN]
        for size in SIZES:
            full = self.picture(tree, "full", size, NEAR)
            shown = {"full": full.on_sky}
            row: dict = {"size": size, "full": full.triangles}
            for kind in list(KINDS)[1:]:
                if tree.has(kind):
                    one = self.picture(tree, kind, size, NEAR)
                    row[kind] = self.differences(full, one)
                    shown[kind] = one.on_sky
            rows.append(row)
            for cell, kind in zip(cells, SHOWN):
                cell.append(shown.get(kind, numpy.full_like(full.on_sky, SKY)))
        return rows, cells

    def sides(self, tree: Tree) -> dict[str, list[dict[str, float]]]:
        """By kind, the differences from all sides."""
        out: dict[str, list[dict[str, float]]] = {kind: [] for kind in FROM_ASIDE if tree.has(kind)}
        for side in SIDES:
            full = self.picture(tree, "full", SIDES_AT, side)
            for kind, found in out.items():
                found.append(self.differences(full, self.picture(tree, kind, SIDES_AT, side)))
        return out


def sheet(rows: list[list[list[numpy.ndarray]]], out: Path) -> None:
    """A band for each tree: a line for each kind, a column for each size, magnified alike."""
    bands = []
    for cells in rows:
        for line in cells:
            parts = []
            for pixels in line:
                at = (numpy.arange(CELL) + 0.5) * len(pixels) / CELL
                parts.append(pixels[at.astype(int)][:, at.astype(int)])
            bands.append(displayed(numpy.concatenate(parts, axis=1)))
        bands.append(numpy.full((6, CELL * len(SIZES), 3), 255.0))
    in_column = (len(SHOWN) + 1) * math.ceil(len(rows) / 2)
    columns = [numpy.concatenate(part) for part in (bands[:in_column], bands[in_column:]) if part]
    wide = CELL * len(SIZES) + 6
    whole = numpy.full((max(map(len, columns)), wide * len(columns) - 6, 3), 255.0)
    for number, column in enumerate(columns):
        whole[: len(column), number * wide : number * wide + wide - 6] = column
    image = Image.fromarray(whole.round().astype(numpy.uint8))
    image.quantize(COLORS, dither=Image.Dither.NONE).save(out, optimize=True)


def table(found: dict[str, dict]) -> list[str]:
    """The lines of both tables."""
    kinds = list(KINDS)[1:]
    lines = [
        "| tree | pixels | full | " + " | ".join(KINDS[kind].title for kind in kinds) + " |",
        "|---|--:|--:|" + "---|" * len(kinds),
    ]
    for name, one in found.items():
        for row in one["sizes"]:
            cells = [name, str(row["size"]), str(row["full"])]
            for kind in kinds:
                cell = row.get(kind)
                cells.append(
                    f"{cell['triangles']}: {cell['area']:.2f}, {cell['color']:.1f}, "
                    f"{cell['ssim']:.3f}"
                    if cell
                    else ""
                )
            lines.append("| " + " | ".join(cells) + " |")
    titles = " | ".join(f"{KINDS[kind].title}: area | color" for kind in FROM_ASIDE)
    lines += [
        "",
        f"From five sides, {SIDES_AT} pixels high, mean (worst):",
        "",
        f"| tree | error of cards, over the height | {titles} |",
        "|---|--:|" + "---|" * 2 * len(FROM_ASIDE),
    ]
    for name, one in found.items():
        cells = [name, "none" if one["error"] is None else f"{one['error']:.3f}"]
        for kind in FROM_ASIDE:
            sides = one["sides"].get(kind)
            if not sides:
                cells += ["", ""]
                continue
            areas = [side["area"] for side in sides]
            colors = [side["color"] for side in sides]
            worst = max(areas, key=lambda area: abs(area - 1))
            cells.append(f"{statistics.mean(areas):.3f} ({worst:.3f})")
            cells.append(f"{statistics.mean(colors):.1f} ({max(colors):.1f})")
        lines.append("| " + " | ".join(cells) + " |")
    return lines


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--trees", nargs="*", default=[], help="these alone, by their last names")
    parser.add_argument("--cache", type=Path, default=bench_real.CACHE)
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "bench" / "trees")
    benching.add_write(parser, "backend")
    options = parser.parse_args()
    if not bench_real.ADDON.is_dir():
        sys.exit("bench_trees.py: build the add-on first")
    sys.path.insert(0, str(bench_real.ADDON))
    import lodestone_native as native

    options.out.mkdir(parents=True, exist_ok=True)
    scenes, bench, busy = (
        bench_real.Scenes(options.cache),
        Bench(native, options.out),
        benching.load(),
    )
    found: dict[str, dict] = {}
    drawn = []
    for track in TREES:
        try:
            for tree in trees_of(track, options.trees, scenes, options.out):
                sizes, cells = bench.sizes(tree)
                height = float(tree.high[2] - tree.low[2])
                found[tree.name] = {
                    "error": tree.card_error / height if tree.has("cards") else None,
                    "sizes": sizes,
                    "sides": bench.sides(tree),
                }
                drawn.append(cells)
                print(f"{tree.name} done", file=sys.stderr)
        except bench_real.Missing as missing:
            print(f"{track} skipped: {missing}", file=sys.stderr)
    if not found:
        sys.exit("bench_trees.py: nothing to draw")
    told = benching.Told()
    told.tell(
        "Triangles: covered area over full detail's, difference of the mean color (of 255), SSIM.\n"
    )
    for line in table(found):
        told.tell(line)
    sheet(drawn, options.out / "sheet.png")
    data = {"load_before": busy, "trees": found}
    benching.write_results(
        benching.results_path(options, "trees"), "Trees from near to far", told, data
    )


if __name__ == "__main__":
    main()
