# SPDX-License-Identifier: GPL-3.0-or-later
"""Adds up JUnit XML files: names what failed, ends with `N passed, N failed, N skipped`.

python3 tests/count.py FILE.xml...         one summary over all files; exit code 1 when a test
                                           failed, a file is missing or broken, or nothing passed
python3 tests/count.py --why FILE.xml...   what the failed tests said, the end of each; always 0
"""

import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import NamedTuple

LINES_OF_EACH = 40


class Test(NamedTuple):
    name: str
    outcome: str  # passed, failed or skipped
    text: str  # what it said


def outcome_of(case: ElementTree.Element) -> str:
    if case.find("failure") is not None or case.find("error") is not None:
        return "failed"
    if case.find("skipped") is not None or case.get("status") == "disabled":
        return "skipped"
    # ctest's "notrun" without a reason: the program is missing.
    return "passed" if case.get("status") in (None, "run") else "failed"


def read_tests(path: Path) -> list[Test]:
    """Every test of the file; a file that cannot be read is one failed test."""
    try:
        root = ElementTree.parse(path).getroot()
    except (OSError, ElementTree.ParseError) as error:
        return [Test(f"{path.stem}: no result", "failed", str(error))]
    return [
        Test(
            f"{path.stem}: {case.get('name')}",
            outcome_of(case),
            "\n".join(filter(None, (part.text for part in case.iter()))),
        )
        for case in root.iter("testcase")
    ]


def print_why(tests: list[Test]) -> None:
    for test in tests:
        if test.outcome == "failed":
            print(f"---- {test.name}")
            print("\n".join(test.text.strip().splitlines()[-LINES_OF_EACH:]))


def print_summary(tests: list[Test]) -> int:
    """Names, then the counts as the last line. Returns the exit code."""
    names = {
        outcome: [test.name for test in tests if test.outcome == outcome]
        for outcome in ("passed", "failed", "skipped")
    }
    for outcome in ("skipped", "failed"):
        if names[outcome]:
            print(f"{outcome.capitalize()}:")
            print("".join(f"    {name}\n" for name in names[outcome]), end="")
    print(", ".join(f"{len(found)} {outcome}" for outcome, found in names.items()))
    return 1 if names["failed"] or not names["passed"] else 0


def main(arguments: list[str]) -> int:
    paths = [Path(argument) for argument in arguments if argument != "--why"]
    tests = [test for path in paths for test in read_tests(path)]
    if "--why" in arguments:
        print_why(tests)
        return 0
    return print_summary(tests)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
