# SPDX-License-Identifier: GPL-3.0-or-later
"""What measuring costs beside the probe it has to beat, in one run.

    /usr/bin/python3 tests/bench/speed/bench_measure.py [--seeds 100] [--rounds 5] [--json FILE]
        [--write]

Builds `bench_measure` in build/release and the probes of LODESTONE_TOOLS (default ../shared/tools)
under build/tools, writes the 20 reference shapes as PLY and prints tables with the goals beside the
numbers: rays, CPU and coverage of the visible area at 1 %, closest points a second, and how stable
an error is over seeds. No number makes it fail; what is absent is skipped with a sentence.
"""

import argparse
import json
import os
import re
import statistics
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from bench import benching  # noqa: E402

ROOT = Path(__file__).resolve().parents[3]
TOOLS = Path(os.environ.get("LODESTONE_TOOLS") or ROOT.parent / "shared" / "tools")
DATA = Path(os.environ.get("LODESTONE_DATA") or ROOT.parent / "shared" / "data")
BUILD = ROOT / "build" / "release"
BENCH = BUILD / "tests" / "bench_measure"
OUT = ROOT / "build" / "tools"
ERROR = 0.01
PROBE_LINE = re.compile(
    r"^(\S+)\s+kdop ([\d.]+)ms .*\| 1%: rays (\d+) ([\d.]+)ms cov (\d+)%", re.MULTILINE
)


def lines_of(*words: str) -> list[dict]:
    """The JSON lines of the bench program."""
    run = subprocess.run([BENCH, *words], check=True, capture_output=True, text=True)
    return [json.loads(line) for line in run.stdout.splitlines()]


def built_probe(name: str) -> Path | None:
    """A probe of the reference shapes, compiled when its source is newer."""
    source = TOOLS / "reference_shapes" / f"{name}.cpp"
    if not source.is_file():
        return None
    OUT.mkdir(parents=True, exist_ok=True)
    program = OUT / name
    if not program.is_file() or program.stat().st_mtime < source.stat().st_mtime:
        words = ["g++", "-O3", "-std=c++17", str(source), "-lembree3", "-ltbb", "-o", str(program)]
        if subprocess.run(words, capture_output=True).returncode != 0:
            return None
    return program


def table(head: list[str], rows: list[list[str]]) -> str:
    return "\n".join("| " + " | ".join(row) + " |" for row in [head, ["---"] * len(head), *rows])


def measured_shapes(seeds: int) -> dict | None:
    probe, writer = built_probe("e1_final"), built_probe("write_shapes")
    if probe is None or writer is None:
        print(f"No probes in {TOOLS}: the estimator is not compared.")
        return None
    shapes = OUT / "shapes"
    shapes.mkdir(exist_ok=True)
    subprocess.run([writer, shapes], check=True)
    files = sorted(str(path) for path in shapes.glob("*.ply"))
    # Side by side, so that a busy machine slows both.
    peer = subprocess.Popen([probe], stdout=subprocess.PIPE, text=True)
    ours = lines_of("shapes", *files, str(seeds), str(ERROR))
    text = peer.communicate()[0]
    found = {}
    for name, bound, rays, cpu, inside in PROBE_LINE.findall(text):
        # Its bound is made once for all seeds; ours, with all that goes before a ray, each time.
        found[name] = {
            "rays": int(rays),
            "cpu_ms": float(cpu) + float(bound),
            "coverage": int(inside),
        }
    return {"ours": ours, "probe": found}


def print_shapes(found: dict, told: benching.Told) -> dict:
    ours, probe = found["ours"], found["probe"]
    rows = []
    for one in ours:
        peer = probe.get(one["shape"])
        theirs = (
            [f"{peer['rays']}", f"{peer['cpu_ms']:.2f}", f"{peer['coverage']} %"]
            if peer
            else ["", "", ""]
        )
        rows.append(
            [one["shape"], one["way"], f"{one['rays']:.0f}", f"{one['cpu_ms']:.2f}"]
            + [f"{100 * one['inside'] / one['seeds']:.0f} %", *theirs]
        )
    both = [one for one in ours if one["shape"] in probe]
    peers = [probe[one["shape"]] for one in both]
    coverages = [one["inside"] / one["seeds"] for one in ours]
    total = {
        "rays": statistics.mean(one["rays"] for one in both),
        "cpu_ms": statistics.mean(one["cpu_ms"] for one in both),
        "coverage": statistics.mean(coverages),
        "least_coverage": min(coverages),
        "probe_rays": statistics.mean(one["rays"] for one in peers),
        "probe_cpu_ms": statistics.mean(one["cpu_ms"] for one in peers),
    }
    rows.append(
        ["**mean**", "", f"**{total['rays']:.0f}**", f"**{total['cpu_ms']:.2f}**"]
        + [f"**{100 * total['coverage']:.1f} %**", f"{total['probe_rays']:.0f}"]
        + [f"{total['probe_cpu_ms']:.2f}"]
        + [f"{statistics.mean(one['coverage'] for one in peers):.1f} %"]
    )
    head = ["shape", "by", "rays", "CPU ms", "within 1 %", "probe: rays", "CPU ms", "within 1 %"]
    told.tell(table(head, rows))
    told.tell(
        f"\nGoals: rays <= {total['probe_rays']:.0f} (now {total['rays']:.0f}), CPU <= "
        f"{total['probe_cpu_ms']:.2f} ms (now {total['cpu_ms']:.2f}), pooled coverage >= 93 % "
        f"(now {100 * total['coverage']:.1f}), least >= 88 % (now "
        f"{100 * total['least_coverage']:.0f}).\n"
    )
    return total


def print_closest(rounds: int, told: benching.Told) -> list[dict]:
    files = [OUT / "shapes" / f"{name}.ply" for name in ("sphere", "tree", "book", "bookshelf")]
    files += [DATA / "models" / f"{name}.ply" for name in ("fandisk", "bunny", "skull")]
    found = lines_of("closest", *(str(path) for path in files if path.is_file()), str(rounds))
    rows = [
        [one["mesh"], str(one["triangles"]), f"{one['build_ms']:.1f}"]
        + [" / ".join(f"{rate:.2f}" for rate in one[how]) for how in ("bare", "hinted")]
        for one in found
    ]
    head = ["mesh", "triangles", "tree ms", "M closest points / s / core", "with a hint"]
    told.tell(table(head, rows))
    least = min((one["hinted"][1] for one in found), default=0)
    told.tell(
        "\nPoints up to 1 % of the radius off the surface, in its order; the hint is the triangle "
        "of the one before, as for errors. Least, median and best of "
        f"{rounds}. Goal: >= 0.4 (slowest median {least:.2f}).\n"
    )
    return found


def print_errors(seeds: int, told: benching.Told) -> list[dict]:
    """Of levels that the command makes here."""
    command = BUILD / "lodestone"
    if not command.is_file() or not (DATA / "models").is_dir():
        print("No command or no models: errors over seeds are not measured.")
        return []
    found = []
    for name in ("fandisk", "bunny", "skull"):
        finest = DATA / "models" / f"{name}.ply"
        levels = []
        for ratio in (0.1, 0.01):
            levels.append(str(OUT / f"{name}_{ratio}.ply"))
            subprocess.run(
                [command, "simplify", finest, levels[-1], "--ratio", str(ratio)],
                check=True,
                capture_output=True,
            )
        for samples in (8192, 2048):
            for one in lines_of("error", str(finest), *levels, str(seeds), str(samples)):
                found.append({**one, "samples": samples})
    rows = [
        [one["level"], str(one["samples"]), f"{one['error']:.4g}", f"{one['max']:.4g}"]
        + [
            f"{100 * one['deviation']:.2f} %",
            f"{100 * one['low']:+.2f} ... {100 * one['high']:+.2f} %",
        ]
        + [f"{one['cpu_ms']:.0f}"]
        for one in found
    ]
    head = ["level", "samples", "99.9 % quantile", "max", "deviation", "range", "CPU ms"]
    told.tell(table(head, rows))
    worst = max((one["deviation"] for one in found if one["samples"] == 8192), default=0)
    told.tell(f"\n{seeds} seeds. Goal: <= 2 % (worst with 8192 samples: {100 * worst:.2f} %).")
    return found


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=100)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--json", type=Path, default=ROOT / "build" / "bench" / "measure.json")
    benching.add_write(parser, "backend")
    arguments = parser.parse_args()
    words = ["cmake", "--build", str(BUILD), "--target", "bench_measure"]
    if subprocess.run(words, capture_output=True).returncode != 0:
        print("`cmake --preset release` first: bench_measure cannot be built.", file=sys.stderr)
        return 1
    report: dict = {"load_before": benching.load()}
    told = benching.Told()
    shapes = measured_shapes(arguments.seeds)
    if shapes is not None:
        report["shapes"] = {**shapes, "mean": print_shapes(shapes, told)}
    report["closest"] = print_closest(arguments.rounds, told)
    report["errors"] = print_errors(10, told)
    arguments.json.parent.mkdir(parents=True, exist_ok=True)
    arguments.json.write_text(json.dumps(report, indent=1))
    page = benching.results_path(arguments, "measure")
    benching.write_results(page, "Measuring", told, report)
    return 0


if __name__ == "__main__":
    sys.exit(main())
