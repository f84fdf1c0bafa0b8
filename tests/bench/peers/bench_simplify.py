# SPDX-License-Identifier: GPL-3.0-or-later
"""How Lodestone's simplification compares with its peers, in one run, on the shared models.

    /usr/bin/python3 tests/bench/peers/bench_simplify.py [--rounds 5] [--models skull ...] [--small]
        [--write]

Blender's Decimate, Debian's meshoptimizer (with simplifySloppy), CGAL, OpenMesh and `lodestone
simplify --mode best | fast | cluster` all get the same position-welded mesh without texture
coordinates and bring it to 50, 10, 2 and 0.5 % of its triangles. mesh_eval of $LODESTONE_TOOLS is
built in build/bench/peers; peers that are not installed are skipped with a sentence. CPU seconds
are those from mesh in memory to mesh in memory, without files; the kinds run by turns. Numbers are
geometric means of ratios to Blender's, over all models and targets both reached. A mesh of a
million triangles (one of the models, cut finer) is brought to 10 % on one and on two threads within
one process: wall and CPU seconds, and the memory above the input. Prints tables and writes JSON; no
number makes it fail. An hour and a half; CGAL takes most of it (--slow-rounds). With --reuse FILE
(the JSON of an earlier run) the peers are not run again: their errors are the same, but their CPU
seconds are those of that hour. A peer's targets share one process, ours have one each;
simplifySloppy is run both ways, and cluster is compared with both.
"""

import argparse
import json
import math
import os
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from bench import benching  # noqa: E402

ROOT = Path(__file__).resolve().parents[3]
BUILD = Path(os.environ.get("LODESTONE_BUILD") or ROOT / "build" / "release")
TOOLS = Path(os.environ.get("LODESTONE_TOOLS") or ROOT.parent / "shared" / "tools")
DATA = Path(os.environ.get("LODESTONE_DATA") or ROOT.parent / "shared" / "data")
TARGETS = (0.5, 0.1, 0.02, 0.005)
MODES = ("best", "fast", "cluster")
# peer program: its modes; the last element tells whether it is slow
PEERS = {
    "peer_meshopt": (("mo018", "mo018_sloppy"), False),
    "peer_cgal": (("cgal_lt", "cgal_gh"), True),
    "peer_openmesh": (("om",), True),
}
# simplifySloppy with a process for each target, as all of ours have: memory that an earlier target
# has touched costs nothing, which is a tenth of what it takes.
ALONE = "mo018_sloppy_alone"
MILLION = "bunny"  # the model that is cut
OPENMESH_MODELS = ("bunny", "fandisk")  # slow and the worst of all: two models will do
LABELS = {
    "blender": "Blender 3.4.1 Decimate",
    "mo018": "meshoptimizer 0.18 simplify",
    "mo018_sloppy": "meshoptimizer 0.18 simplifySloppy",
    "cgal_lt": "CGAL Lindstrom-Turk",
    "cgal_gh": "CGAL Garland-Heckbert",
    "om": "OpenMesh ModQuadric",
    "best": "**Lodestone best**",
    "fast": "**Lodestone fast**",
    "cluster": "**Lodestone cluster**",
}
# Smaller errors are as good as none: exact flat models must not decide a mean.
FLOORS = {
    "mean": 1e-6,
    "rms": 1e-6,
    "hausdorff": 1e-5,
    "normal_deg": 0.05,
    "sil_iou_err": 1e-4,
}
GOALS = {  # as many times Blender's, at most
    "best": {
        "mean": 0.50,
        "rms": 0.60,
        "hausdorff": 1.00,
        "normal_deg": 0.75,
        "sil_iou_err": 0.70,
        "cpu": 0.50,
    },
    "fast": {
        "mean": 0.60,
        "rms": 0.75,
        "hausdorff": 1.2,
        "normal_deg": 0.85,
        "sil_iou_err": 0.75,
        "cpu": 0.12,
    },
}
MILLION_GOALS = {"wall": 0.6, "bytes": 100}  # seconds on two cores; above the input, a triangle
SLOPPY_GOALS = {"mean": 0.6, "cpu": 1.3}  # of cluster, as many times simplifySloppy's
TIMEOUT = 1800


def say(sentence: str) -> None:
    print(f"bench_simplify.py: {sentence}", file=sys.stderr, flush=True)


def run(command: list, **options) -> str | None:
    """What it prints; None, with the reason said, when it fails."""
    words = [str(word) for word in command]
    try:
        done = subprocess.run(
            words, capture_output=True, text=True, timeout=TIMEOUT, check=False, **options
        )
    except subprocess.TimeoutExpired:
        say(f"{words[0]} took more than {TIMEOUT} s and was ended")
        return None
    if done.returncode != 0:
        say(f"{' '.join(words[:4])} ... failed: {done.stderr[-500:]}")
        return None
    return done.stdout


def build_peers(folder: Path) -> Path | None:
    """The folder with mesh_eval's programs; None, with the reason said, when there are none."""
    source = TOOLS / "mesh_eval"
    if not (source / "evaluate.cpp").is_file():
        say(f"skipped, there is no {source}")
        return None
    place = folder / "peers"
    configure = ["cmake", "-S", Path(__file__).parent, "-B", place]
    if run([*configure, f"-DMESH_EVAL={source}"]) is None:
        return None
    run(["cmake", "--build", place, "--", "-k"])
    if not all((place / name).is_file() for name in ("evaluate", "convert")):
        say("skipped, mesh_eval could not be built")
        return None
    return place


def records(text: str | None) -> list[dict]:
    return [json.loads(line) for line in (text or "").splitlines() if line.startswith("{")]


def wanted(triangles: int, target: float) -> int:
    return max(4, round(triangles * target))


def missed(one: dict) -> bool:
    return one["got"] > 1.05 * one["want"] + 8


class Bench:
    def __init__(self, options: argparse.Namespace, peers: Path):
        self.options = options
        self.peers = peers
        self.out = options.folder / "simplified"
        self.out.mkdir(parents=True, exist_ok=True)
        self.targets = ",".join(f"{target:g}" for target in options.targets)
        self.found: dict[tuple[str, str, float], dict] = {}  # by peer, model, target

    def weld(self, source: Path) -> tuple[Path, int] | None:
        name = source.stem.removesuffix("_uv")
        welded = self.out / f"{name}.ply"
        text = run([self.peers / "convert", source, welded, "--weld"])
        return None if text is None else (welded, int(text.split(" triangles ")[1].split()[0]))

    def keep(self, peer: str, model: str, one: dict) -> None:
        """The first round's result is judged, all rounds' CPU seconds are kept."""
        key = (peer, model, float(one["target"]))
        held = self.found.setdefault(key, {**one, "cpus": []})
        held["cpus"].append(one["cpu"])

    def run_blender(self, mesh: Path) -> None:
        command = ["blender", "-b", "--factory-startup", "-t", "1", "--python-exit-code", "1"]
        command += ["-P", TOOLS / "mesh_eval" / "peer_blender.py", "--", mesh, self.out / mesh.stem]
        for one in records(run([*command, self.targets])):
            self.keep("blender", mesh.stem, one)

    def run_peer(self, program: str, mesh: Path) -> None:
        modes = ",".join(PEERS[program][0])
        prefix = self.out / mesh.stem
        for one in records(run([self.peers / program, mesh, prefix, self.targets, modes])):
            self.keep(one["peer"], mesh.stem, one)

    def run_sloppy_alone(self, mesh: Path) -> None:
        for target in self.options.targets:
            command = [self.peers / "peer_meshopt", mesh, self.out / mesh.stem, f"{target:g}"]
            for one in records(run([*command, "mo018_sloppy"])):
                self.keep(ALONE, mesh.stem, one | {"peer": ALONE})

    def run_ours(self, mesh: Path, triangles: int, mode: str) -> None:
        report = self.out / "report.json"
        for target in self.options.targets:
            out = self.out / f"{mesh.stem}.{mode}.{target:g}.ply"
            want = wanted(triangles, target)
            command = [BUILD / "lodestone", "simplify", mesh, out, "--triangles", want]
            if run([*command, "--mode", mode, "--threads", "1", "--json", report]) is None:
                continue
            done = json.loads(report.read_text("utf-8"))["simplify"]
            one = {"target": target, "want": want, "got": done["triangles"], "error": ""}
            one |= {"cpu": done["cpu_s"], "dropped": triangles - done["triangles_before"]}
            self.keep(mode, mesh.stem, one | {"out": str(out), "in_tris": triangles})

    def round(self, number: int, mesh: Path, triangles: int) -> None:
        for mode in MODES:
            self.run_ours(mesh, triangles, mode)
        if (self.peers / "peer_meshopt").is_file():
            self.run_sloppy_alone(mesh)
        if self.options.reuse:
            return
        self.run_blender(mesh)
        for program, (_, slow) in PEERS.items():
            if not (self.peers / program).is_file():
                continue
            if slow and number >= self.options.slow_rounds:
                continue
            if program == "peer_openmesh" and mesh.stem not in OPENMESH_MODELS:
                continue
            self.run_peer(program, mesh)

    def judge(self, mesh: Path) -> None:
        ones = [one for (_, model, _), one in self.found.items() if model == mesh.stem]
        ones = [one for one in ones if not one["error"] and "judged" not in one]
        command = [self.peers / "evaluate", mesh, *(one["out"] for one in ones)]
        judged = records(run([*command, "--samples", self.options.samples]))
        by_file = {one["file"]: one for one in judged}
        for one in ones:
            one["judged"] = by_file.get(one["out"], {"error": "not judged"})

    def reuse(self, file: Path) -> None:
        """The peers' results of an earlier run of this machine, as they were judged then."""
        for one in json.loads(file.read_text("utf-8"))["results"]:
            if one["peer"] not in (*MODES, ALONE) and one["target"] in self.options.targets:
                self.found[(one["peer"], one["model"], float(one["target"]))] = one

    def measure(self, sources: list[Path]) -> None:
        for source in sources:
            welded = self.weld(source)
            if welded is None:
                continue
            for number in range(self.options.rounds):
                self.round(number, *welded)
                print(f"{welded[0].stem}: round {number + 1}", flush=True)
            self.judge(welded[0])


def usable(one: dict | None) -> bool:
    return one is not None and "mean" in one.get("judged", {}) and not missed(one)


def geometric_mean(numbers: list[float]) -> float:
    return math.exp(sum(map(math.log, numbers)) / len(numbers)) if numbers else math.nan


def compared(found: dict, peer: str, base: str) -> dict:
    """Geometric means of the ratios where both reached the target; CPU as spread of the rounds."""
    pairs = [
        (one, found[(base, model, target)])
        for (name, model, target), one in found.items()
        if name == peer and usable(one) and usable(found.get((base, model, target)))
    ]
    out: dict = {"pairs": len(pairs)}
    for measure, floor in FLOORS.items():
        ratios = [
            max(floor, one["judged"][measure]) / max(floor, other["judged"][measure])
            for one, other in pairs
        ]
        out[measure] = geometric_mean(ratios)
    rounds = min((len(x["cpus"]) for pair in pairs for x in pair), default=0)
    each = [
        geometric_mean(
            [max(one["cpus"][i], 1e-5) / max(other["cpus"][i], 1e-5) for one, other in pairs]
        )
        for i in range(rounds)
    ]
    if each:
        out["cpu"] = benching.spread(each)
    mine = [one for (name, _, _), one in found.items() if name == peer]
    out["runs"] = len(mine)
    out["missed"] = sum(1 for one in mine if missed(one))
    out["failed"] = sum(1 for one in mine if one["error"])
    out["empty"] = sum(1 for one in mine if one["got"] == 0)
    out["dropped"] = sum(one["dropped"] for one in mine)
    return out


def cell(number: float, goal: float | None) -> str:
    text = "-" if math.isnan(number) else f"{number:.2f}"
    return text if goal is None else f"{text} (<= {goal:g})"


def cpu_cell(cpu: dict | None, goal: float | None) -> str:
    if cpu is None:
        return "-"
    text = benching.cell(cpu, digits=3)
    return text if goal is None else f"{text} (<= {goal:g})"


def table(found: dict) -> list[str]:
    """Markdown: everyone beside Blender, goals in brackets."""
    lines = [
        "| | pairs | mean | RMS | Hausdorff | normals | silhouette | CPU: min / median / max "
        "| missed | empty | dropped |",
        "|---|" + "---|" * 10,
    ]
    for peer, label in LABELS.items():
        if not any(name == peer for name, _, _ in found):
            continue
        one, goals = compared(found, peer, "blender"), GOALS.get(peer, {})
        cells = [str(one["pairs"])]
        cells += [cell(one[measure], goals.get(measure)) for measure in FLOORS]
        cells.append(cpu_cell(one.get("cpu"), goals.get("cpu")))
        cells.append(f"{one['missed']} of {one['runs']}")
        cells += [str(one["empty"]), str(one["dropped"])]
        lines.append(f"| {label} | " + " | ".join(cells) + " |")
    return lines


def target_table(found: dict, targets: tuple) -> list[str]:
    """Markdown: mean error and CPU at each target, beside Blender's."""
    lines = [
        "| mean; CPU | " + " | ".join(f"{100 * target:g} %" for target in targets) + " |",
        "|---|" + "---|" * len(targets),
    ]
    for peer, label in LABELS.items():
        cells = []
        for target in targets:
            part = {key: one for key, one in found.items() if key[2] == target}
            one = compared(part, peer, "blender")
            middle = one["cpu"]["median"] if "cpu" in one else math.nan
            cells.append(f"{cell(one['mean'], None)}; {middle:.3f}" if one["pairs"] else "-")
        if any(text != "-" for text in cells):
            lines.append(f"| {label} | " + " | ".join(cells) + " |")
    return lines


def million(mesh: Path, rounds: int) -> list[dict]:
    """What bench_collapse measures on the mesh, cut until it has a million triangles."""
    if run(["cmake", "--build", BUILD, "--target", "bench_collapse"]) is None:
        return []
    program = BUILD / "tests" / "bench_collapse"
    return [
        {"threads": threads, **one}
        for mode in ("fast", "best")
        for threads in (1, 2)
        for one in records(run([program, mode, 0.1, 1, rounds, threads, mesh]))
    ]


def million_table(ones: list[dict]) -> list[str]:
    """Markdown: seconds and memory of each mode on one thread and on two."""
    wall, most = MILLION_GOALS["wall"], MILLION_GOALS["bytes"]
    lines = [
        f"| a million triangles to 10 % | wall s (<= {wall:g} on 2 idle cores) | CPU s "
        f"| bytes a triangle (<= {most:g}) |",
        "|---|---|---|---|",
    ]
    for mode in ("fast", "best"):
        for threads in (1, 2):
            part = [one for one in ones if (one["mode"], one["threads"]) == (mode, threads)]
            if part:
                cells = [
                    benching.cell(benching.spread([one[key] for one in part]))
                    for key in ("wall", "cpu")
                ]
                cells.append(f"{max(one['bytes'] for one in part):.0f}")
                lines.append(f"| {mode}, {threads} threads | " + " | ".join(cells) + " |")
    return lines


def sloppy_sentence(found: dict) -> str:
    parts = []
    for peer, how in (
        (ALONE, "a process for each target"),
        ("mo018_sloppy", "one for all targets"),
    ):
        if not any(name == peer for name, _, _ in found):
            continue
        one = compared(found, "cluster", peer)
        parts.append(
            f"with {how} ({one['pairs']} pairs): mean {cell(one['mean'], SLOPPY_GOALS['mean'])}, "
            f"CPU {cpu_cell(one.get('cpu'), SLOPPY_GOALS['cpu'])}"
        )
    if not parts:
        return "Cluster beside simplifySloppy: not measured, meshoptimizer is not installed."
    return "Cluster, a process for each target, beside simplifySloppy " + "; ".join(parts)


def options_of(arguments: list[str] | None = None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--slow-rounds", type=int, default=1, help="of CGAL and OpenMesh")
    parser.add_argument("--models", nargs="+", default=[], help="stems, e.g. skull pizza_uv")
    parser.add_argument("--samples", type=int, default=100_000)
    parser.add_argument("--reuse", type=Path, default=None, help="an earlier run's JSON")
    parser.add_argument(
        "--small", action="store_true", help="two models, two targets, a round, no slow peers"
    )
    parser.add_argument("--folder", type=Path, default=ROOT / "build" / "bench")
    parser.add_argument("--json", type=Path, default=None)
    benching.add_write(parser, "backend")
    options = parser.parse_args(arguments)
    options.targets = TARGETS
    if options.small:
        options.rounds, options.slow_rounds, options.samples = 1, 0, 20_000
        options.models = options.models or ["fandisk", "beetle_open"]
        options.targets = (0.1, 0.02)
    if options.rounds < 1 or options.slow_rounds < 0 or options.samples < 1:
        parser.error("--rounds and --samples are at least 1, --slow-rounds 0")
    options.folder = options.folder.resolve()
    options.json = options.json or options.folder / "simplify.json"
    return options


def main() -> None:
    options = options_of()
    if not (BUILD / "lodestone").is_file():
        sys.exit("bench_simplify.py: build first (cmake --build --preset release)")
    models = sorted((DATA / "models").glob("*.*"))
    sources = [one for one in models if not options.models or one.stem in options.models]
    if not sources:
        print(f"bench_simplify.py: skipped, there are no models in {DATA / 'models'}")
        return
    busy = benching.load()
    peers = build_peers(options.folder)
    if peers is None:
        print("bench_simplify.py: nothing to measure with, skipped")
        return
    for program, (modes, slow) in PEERS.items():
        if not (peers / program).is_file():
            say(f"{', '.join(LABELS[mode] for mode in modes)}: skipped, not installed")
        elif slow and options.slow_rounds == 0:
            say(f"{', '.join(LABELS[mode] for mode in modes)}: skipped, slow")
    bench = Bench(options, peers)
    if options.reuse:
        bench.reuse(options.reuse)
    bench.measure(sources)
    stems = {source.stem.removesuffix("_uv") for source in sources}
    found = {key: one for key, one in bench.found.items() if key[1] in stems}
    told = benching.Told()
    told.tell(
        f"Blender = 1; {len(sources)} models; CPU of {options.rounds} rounds; {os.cpu_count()} "
        f"cores, load {busy:.1f} before the first\n"
    )
    told.tell("\n".join(table(found)) + "\n")
    told.tell("\n".join(target_table(found, options.targets)) + "\n")
    told.tell(sloppy_sentence(found) + "\n")
    mesh = bench.out / f"{MILLION}.ply"
    ones = million(mesh, options.rounds) if mesh.is_file() and not options.small else []
    if ones:
        told.tell("\n".join(million_table(ones)))
    data = {
        "input": [str(source) for source in sources],
        "goals": {**GOALS, "cluster_beside_sloppy": SLOPPY_GOALS, "million": MILLION_GOALS},
        "million": ones,
        "results": [
            {"peer": peer, "model": model, **one} for (peer, model, _), one in found.items()
        ],
    }
    benching.write(options.json, busy, data)
    title = "Simplification beside its peers"
    page = benching.results_path(options, "simplify")
    benching.write_results(page, title, told, {"load_before": busy, **data})


if __name__ == "__main__":
    main()
