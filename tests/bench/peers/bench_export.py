# SPDX-License-Identifier: GPL-3.0-or-later
"""What exporting costs beside the POV-Ray add-on that Blender brings, on the stress scenes.

    /usr/bin/python3 tests/bench/peers/bench_export.py [--scenes S1 S2 S3] [--rounds 5] [--small]
        [--write]

S1 is one smooth mesh of 500,002 triangles, S2 2,000 copies of one tree, S3 3,001 different meshes
of 3,448,392 triangles. make_scenes.py of $LODESTONE_TOOLS/peer_povray makes them in build/bench
(it needs numpy); without it there is nothing to do. Each export is a Blender of its own, the two
kinds by turns, and counts user and system time of the export only: from an evaluated scene to
files, at full detail, no levels built. Prints a table and writes JSON; no number makes it fail.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from bench import benching  # noqa: E402

ROOT = Path(__file__).resolve().parents[3]
STAGE = Path(os.environ.get("LODESTONE_STAGE") or ROOT / "build" / "release" / "stage")
TOOLS = Path(os.environ.get("LODESTONE_TOOLS") or ROOT.parent / "shared" / "tools")
INSIDE = Path(__file__).with_name("bench_export_blender.py")
SCENES = ("S1", "S2", "S3")
KINDS = ("bundled", "lodestone")
GOAL_RATIO = 12.0  # bundled over lodestone
GOAL_PER_MILLION = 1.3  # CPU s for a million triangles
FEW = 100_000  # triangles; per million of them says nothing about smaller scenes
TIMEOUT = 900


def summary(rounds: list[dict]) -> dict[str, dict]:
    """Spreads over the rounds, {kind: what it took} each; ratios are of one round each."""
    out = {}
    for measure in ("cpu_s", "bytes", "memory_bytes"):
        for kind in KINDS:
            out[f"{kind}_{measure}"] = benching.spread([one[kind][measure] for one in rounds])
        pairs = [(one["bundled"][measure], one["lodestone"][measure]) for one in rounds]
        least = 1e-3 if measure == "cpu_s" else 1.0
        out[f"{measure}_ratio"] = benching.spread([a / max(b, least) for a, b in pairs])
    ours = [one["lodestone"] for one in rounds]
    for measure in ("extract_cpu_s", "write_cpu_s", "depsgraph_cpu_s"):
        out[measure] = benching.spread([one[measure] for one in ours])
    out["second_cpu_s"] = benching.spread([one["second_frame"]["cpu_s"] for one in ours])
    out["second_written"] = benching.spread([one["second_frame"]["files_written"] for one in ours])
    if ours[0]["triangles"] >= FEW:
        out["per_million"] = benching.spread(
            [1e6 * one["cpu_s"] / one["triangles"] for one in ours]
        )
    return out


def table(found: dict[str, dict]) -> list[str]:
    """Markdown of {scene: summary}: minimum / median / maximum of the rounds."""
    lines = [
        "| | " + " | ".join(found) + " | goal |",
        "|---|" + "---|" * (len(found) + 1),
    ]

    def row(label: str, key: str, unit: float = 1.0, digits: int = 2, goal: str = "") -> None:
        cells = [
            benching.cell(one[key], unit, digits) if key in one else "" for one in found.values()
        ]
        lines.append(f"| {label} | " + " | ".join(cells) + f" | {goal} |")

    row("bundled add-on, CPU s", "bundled_cpu_s")
    row("Lodestone, CPU s", "lodestone_cpu_s", digits=3)
    row("of it extracting", "extract_cpu_s", digits=3)
    row("of it choosing and writing", "write_cpu_s", digits=3)
    row("**bundled / Lodestone**", "cpu_s_ratio", digits=1, goal=f">= {GOAL_RATIO:g}")
    row("**Lodestone, CPU s / 1 M triangles**", "per_million", goal=f"<= {GOAL_PER_MILLION:g}")
    row("the next frame, nothing changed, CPU s", "second_cpu_s", digits=3)
    row("files it writes", "second_written", digits=0)
    row("bundled add-on writes, MB", "bundled_bytes", 1e6, 1)
    row("Lodestone writes, MB", "lodestone_bytes", 1e6, 1)
    row("bundled add-on, peak memory, MB", "bundled_memory_bytes", 1e6, 0)
    row("Lodestone, peak memory, MB", "lodestone_memory_bytes", 1e6, 0)
    row("in both: Blender's render depsgraph, CPU s", "depsgraph_cpu_s")
    return lines


def make_scene(name: str, folder: Path) -> Path | None:
    """The .blend, made when it is not there; None, with the reason printed, when it cannot be."""
    blend = folder / f"{name}.blend"
    if blend.is_file():
        return blend
    maker = TOOLS / "peer_povray" / "make_scenes.py"
    if not maker.is_file():
        print(f"bench_export.py: {name} is skipped, there is no {maker}", file=sys.stderr)
        return None
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=folder) as scratch:  # one that is killed leaves no half
        command = ["blender", "-b", "--factory-startup", "--python", str(maker), "--", name]
        done = subprocess.run(command, cwd=scratch, capture_output=True, text=True, check=False)
        made = Path(scratch) / blend.name
        if not made.is_file():
            print(f"bench_export.py: {name} is skipped:\n{done.stdout[-2000:]}", file=sys.stderr)
            return None
        made.rename(blend)
    return blend


def export(kind: str, blend: Path, scratch: Path) -> dict:
    """Into a folder of its own: on ext4, files made where others were just deleted cost more."""
    folder = scratch / f"{blend.stem}_{len(list(scratch.iterdir()))}"
    report = scratch / "report.json"
    report.unlink(missing_ok=True)
    command = ["blender", "-b", "--factory-startup", str(blend), "--python-exit-code", "1"]
    command += ["--python", str(INSIDE), "--", kind, str(folder), str(report)]
    command.append(str(STAGE / "addons"))
    done = subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT, check=False)
    if done.returncode != 0 or not report.is_file():
        sys.exit(f"bench_export.py: {kind} failed on {blend}:\n{done.stdout[-2000:]}{done.stderr}")
    return json.loads(report.read_text("utf-8"))


def measured(blend: Path, rounds: int) -> list[dict]:
    """The rounds: {kind: what it took}."""
    found: list[dict] = [{} for _ in range(rounds)]
    with tempfile.TemporaryDirectory(dir=blend.parent) as scratch:
        for number, kind in benching.turns(rounds, KINDS):
            found[number][kind] = export(kind, blend, Path(scratch))
            print(f"{blend.stem} {number} {kind}: {found[number][kind]['cpu_s']:.3f} s", flush=True)
    return found


def options_of(arguments: list[str] | None = None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scenes", nargs="+", choices=SCENES, default=list(SCENES))
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--small", action="store_true", help="S1 and S2 only, two rounds")
    parser.add_argument("--folder", type=Path, default=ROOT / "build" / "bench")
    parser.add_argument("--json", type=Path, default=None)
    benching.add_write(parser, "povray_export")
    options = parser.parse_args(arguments)
    if options.small:
        options.scenes, options.rounds = ["S1", "S2"], 2
    if options.rounds < 1:
        parser.error("--rounds is at least 1")
    options.json = options.json or options.folder / "export.json"
    return options


def main() -> None:
    options = options_of()
    if not (STAGE / "addons" / "lodestone").is_dir():
        sys.exit("bench_export.py: build first (cmake --build --preset release)")
    busy = benching.load()
    folder = options.folder.resolve()
    blends = {name: make_scene(name, folder) for name in options.scenes}
    rounds = {name: measured(blend, options.rounds) for name, blend in blends.items() if blend}
    if not rounds:
        print("bench_export.py: nothing to measure, skipped")
        return
    found = {name: summary(one) for name, one in rounds.items()}
    told = benching.Told()
    told.tell(f"{benching.said(options.rounds, busy)}\n")
    told.tell("\n".join(table(found)))
    data = {
        "input": sorted(rounds),
        "goals": {"ratio": GOAL_RATIO, "per_million": GOAL_PER_MILLION},
        "rounds": rounds,
        "summary": found,
    }
    benching.write(options.json, busy, data)
    page = benching.results_path(options, "export")
    benching.write_results(page, "What an export costs", told, {"load_before": busy, **data})


if __name__ == "__main__":
    main()
