# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a bench that is a C++ program, and writes what it prints as a page of results.

    /usr/bin/python3 tests/bench/speed/bench_program.py cut [--write]
    /usr/bin/python3 tests/bench/speed/bench_program.py builds [--write]
    /usr/bin/python3 tests/bench/speed/bench_program.py crowds [--write]
    /usr/bin/python3 tests/bench/speed/bench_program.py surfaces [--write] [-- SIDE ...]
    /usr/bin/python3 tests/bench/speed/bench_program.py textures [--write] [-- FILE.obj ...]
    /usr/bin/python3 tests/bench/speed/bench_program.py group [--write] [-- --flat 1000 STORE ...]

Builds the program in build/release first; its source (bench_builds.cpp, bench_cut.cpp,
bench_crowds.cpp, bench_group.cpp, bench_surfaces.cpp, errors/bench_textures.cpp) tells what it
measures and what the words after -- are; bench_textures takes the textured models of
$LODESTONE_DATA (default ../shared/data) where none are given. No number makes it fail.
"""

import argparse
import os
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from bench import benching  # noqa: E402

BUILD = benching.ROOT / "build" / "release"
TITLES = {
    "builds": "Builds after changes",
    "cut": "Choosing",
    "group": "Grouping",
    "crowds": "Crowds from afar",
    "surfaces": "Large surfaces",
    "textures": "Textures on simplified models",
}


def options_of(arguments: list[str] | None = None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", choices=TITLES)
    parser.add_argument("words", nargs="*", help="for the program")
    benching.add_write(parser, "backend")
    return parser.parse_intermixed_args(arguments)


def textured_models() -> list[str]:
    data = Path(os.environ.get("LODESTONE_DATA") or benching.ROOT.parent / "shared" / "data")
    return [str(model) for model in sorted((data / "models").glob("*_uv.obj"))]


def main() -> None:
    options = options_of()
    name = f"bench_{options.program}"
    words = ["cmake", "--build", str(BUILD), "--target", name]
    if subprocess.run(words, stdout=subprocess.DEVNULL, check=False).returncode != 0:
        sys.exit(f"bench_program.py: {name} cannot be built; cmake --preset release first")
    busy = benching.load()
    told = benching.Told()
    if options.program == "textures" and not options.words:
        options.words = textured_models()
        if not options.words:
            print("bench_program.py: skipped, there are no textured models")
            return
    command = [str(BUILD / "tests" / name), *options.words]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as running:
        for line in running.stdout or ():
            told.tell(line.rstrip("\n"))
    if running.returncode != 0:
        sys.exit(f"bench_program.py: {name} ended with {running.returncode}")
    page = benching.results_path(options, options.program)
    data = {"load_before": busy, "lines": list(told)}
    benching.write_results(page, TITLES[options.program], told, data)


if __name__ == "__main__":
    main()
