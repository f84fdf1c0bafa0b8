# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a GoogleTest program in a few processes and writes one JUnit XML file of all its tests.

    python3 tests/run_shards.py --junit OUT.xml [--seconds 900] PROGRAM [--gtest_filter=...]

Where starting costs more than most tests, as under sanitizers, a process for each test is too much.
A process that crashes, hangs, leaks or says nothing is one failed test more, named by the test that
it was in: nothing is lost silently. Exit code 0 when nothing failed.
"""

import argparse
import os
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

SHARDS_PER_PROCESSOR = 12  # what a crash takes with it is at most one of these
BEGUN = re.compile(r"^\[ RUN      \] (\S+)", re.MULTILINE)
LAST_CHARACTERS = 8000


def cases_of(junit: Path) -> list[ElementTree.Element]:
    """The tests of one process, by their full names; none when it wrote nothing readable."""
    try:
        cases = list(ElementTree.parse(junit).getroot().iter("testcase"))
    except (OSError, ElementTree.ParseError):
        return []
    for case in cases:
        case.set("name", f"{case.get('classname')}.{case.get('name')}")
    return cases


def failed(name: str, why: str) -> ElementTree.Element:
    case = ElementTree.Element("testcase", name=name, status="run")
    text = "".join(c if c.isprintable() or c in "\n\t" else "?" for c in why)
    ElementTree.SubElement(case, "failure", message=name).text = text
    return case


def run_shard(command: list[str], index: int, count: int, seconds: float, folder: Path):
    """(what it printed, its tests) of one process."""
    junit = folder / f"{index}.xml"
    shard = {"GTEST_TOTAL_SHARDS": str(count), "GTEST_SHARD_INDEX": str(index)}
    with open(folder / f"{index}.log", "w+b") as log:
        try:
            code = subprocess.run(
                [*command, f"--gtest_output=xml:{junit}"],
                env={**os.environ, **shard},
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=subprocess.STDOUT,
                timeout=seconds,
            ).returncode
            ended = f"exit code {code}"
        except subprocess.TimeoutExpired:
            code, ended = None, f"stopped after {seconds:.0f} s"
        log.seek(0)
        said = log.read().decode("utf-8", "replace")
    cases = cases_of(junit)
    explained = any(case.find("failure") is not None for case in cases)
    if not cases or (code != 0 and not explained):
        begun = BEGUN.findall(said)
        place = begun[-1] if begun and not cases else f"part {index + 1} of {count}"
        cases.append(failed(f"{place} ({ended})", said[-LAST_CHARACTERS:]))
    return said, cases


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--junit", type=Path, required=True)
    parser.add_argument("--seconds", type=float, default=900)
    parser.add_argument("program")
    options, more = parser.parse_known_args()
    processors = os.cpu_count() or 1
    count = SHARDS_PER_PROCESSOR * processors
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(processors) as pool:
        results = list(
            pool.map(
                lambda index: run_shard(
                    [options.program, *more], index, count, options.seconds, Path(folder)
                ),
                range(count),
            )
        )
    root = ElementTree.Element("testsuite", name=options.junit.stem)
    for said, cases in results:
        print(said)
        root.extend(cases)
    ElementTree.ElementTree(root).write(options.junit, encoding="utf-8", xml_declaration=True)
    return 1 if any(case.find("failure") is not None for case in root) else 0


if __name__ == "__main__":
    sys.exit(main())
