# SPDX-License-Identifier: GPL-3.0-or-later
"""How mode best compares with mode fast: no error of any model at any target may be larger.

    /usr/bin/python3 tests/bench/peers/bench_modes.py [--rounds 3] [--models skull ...]
        [--more FILE ...] [--write]

`lodestone simplify --mode best` and `fast` bring the shared models, and any meshes of --more (PLY,
OBJ), to 50, 10, 2 and 0.5 % of their triangles, one thread each; mesh_eval of $LODESTONE_TOOLS
judges both from samples and views of its own, not those that best decides by. Prints for each error
the mean ratio, the pairs in which best is worse than fast by more than a fiftieth, and the worst
pairs; and the ratio of CPU seconds. Ten minutes. No number makes it fail.
"""

import argparse
import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from bench import benching  # noqa: E402
from bench.peers import bench_simplify  # noqa: E402

NAMES = {
    "mean": "mean",
    "rms": "RMS",
    "hausdorff": "Hausdorff",
    "normal_deg": "normals",
    "sil_iou_err": "silhouette",
}
WORSE = 1.02  # what other samples of the same surfaces may make of equal errors


def ratios(found: dict, measure: str) -> list[tuple[float, str]]:
    """Best's error over fast's, the worst pair first."""
    floor = bench_simplify.FLOORS[measure]
    out = []
    for (mode, model, target), best in found.items():
        fast = found.get(("fast", model, target))
        if mode == "best" and "mean" in best["judged"] and fast and "mean" in fast["judged"]:
            ratio = max(floor, best["judged"][measure]) / max(floor, fast["judged"][measure])
            out.append((ratio, f"{model} at {100 * target:g} %"))
    return sorted(out, reverse=True)


def error_table(found: dict) -> list[str]:
    lines = ["| best / fast | pairs | mean | worse | the worst |", "|---|---|---|---|---|"]
    for measure, name in NAMES.items():
        all_pairs = ratios(found, measure)
        worse = sum(1 for ratio, _ in all_pairs if ratio > WORSE)
        mean = bench_simplify.geometric_mean([ratio for ratio, _ in all_pairs])
        worst = ", ".join(f"{pair} {ratio:.2f}" for ratio, pair in all_pairs[:3])
        lines.append(f"| {name} | {len(all_pairs)} | {mean:.3f} | {worse} | {worst} |")
    return lines


def cpu_table(found: dict, targets: tuple) -> list[str]:
    lines = [
        "| | " + " | ".join(f"{100 * target:g} %" for target in targets) + " |",
        "|---|" + "---|" * len(targets),
    ]
    cells = []
    for target in targets:
        part = {key: one for key, one in found.items() if key[2] == target}
        spread = bench_simplify.compared(part, "best", "fast").get("cpu")
        cells.append(benching.cell(spread, digits=2) if spread else "-")
    lines.append("| CPU of best / fast: min / median / max | " + " | ".join(cells) + " |")
    return lines


def options_of() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--models", nargs="+", default=[], help="stems, e.g. skull pizza_uv")
    parser.add_argument("--more", nargs="+", type=Path, default=[], help="other meshes")
    parser.add_argument("--samples", type=int, default=100_000)
    parser.add_argument("--folder", type=Path, default=bench_simplify.ROOT / "build" / "bench")
    benching.add_write(parser, "backend")
    options = parser.parse_args()
    if options.rounds < 1 or options.samples < 1:
        parser.error("--rounds and --samples are at least 1")
    options.folder = options.folder.resolve()
    options.targets = bench_simplify.TARGETS
    return options


def main() -> None:
    options = options_of()
    models = sorted((bench_simplify.DATA / "models").glob("*.*"))
    sources = [one for one in models if not options.models or one.stem in options.models]
    sources += options.more
    peers = bench_simplify.build_peers(options.folder)
    if not sources or peers is None:
        print("bench_modes.py: nothing to measure or nothing to measure with, skipped")
        return
    busy = benching.load()
    bench = bench_simplify.Bench(options, peers)
    for source in sources:
        welded = bench.weld(source)
        if welded is None:
            continue
        for _ in range(options.rounds):
            for mode in ("fast", "best"):
                bench.run_ours(*welded, mode)
        bench.judge(welded[0])
        print(f"{welded[0].stem}: done", file=sys.stderr, flush=True)
    told = benching.Told()
    told.tell(
        f"{len(sources)} models, {len(options.more)} of them given by hand; CPU of "
        f"{options.rounds} rounds; {os.cpu_count()} cores, load {busy:.1f} before the first\n"
    )
    told.tell("\n".join(error_table(bench.found)) + "\n")
    told.tell("\n".join(cpu_table(bench.found, options.targets)))
    data = {
        "load_before": busy,
        "results": [
            {"mode": mode, "model": model, **{k: v for k, v in one.items() if k != "out"}}
            for (mode, model, _), one in bench.found.items()
        ],
    }
    for one in data["results"]:
        one["judged"].pop("file", None)
    page = benching.results_path(options, "simplify_modes")
    benching.write_results(page, "Simplification: best beside fast", told, data)


if __name__ == "__main__":
    main()
