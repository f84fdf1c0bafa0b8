# SPDX-License-Identifier: GPL-3.0-or-later
"""Adds up JUnit XML files: names what failed, ends with `N passed, N failed, N skipped`.

python3 tests/count.py FILE.xml...     one summary over all files; exit code 1 when a test failed,
                                       a file is missing or broken, or nothing passed
"""

import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path


def outcomes(path: Path) -> list[tuple[str, str]]:
    """(name, outcome) of every test in the file; a file that cannot be read is one failed test."""
    try:
        root = ElementTree.parse(path).getroot()
    except (OSError, ElementTree.ParseError) as error:
        return [(f"{path.stem}: no result ({error})", "failed")]
    found = []
    for case in root.iter("testcase"):
        name = f"{path.stem}: {case.get('name')}"
        if case.find("failure") is not None or case.find("error") is not None:
            found.append((name, "failed"))
        elif case.find("skipped") is not None or case.get("status") == "disabled":
            found.append((name, "skipped"))
        elif case.get("status") in (None, "run"):
            found.append((name, "passed"))
        else:  # ctest's "notrun" without a reason: the program is missing
            found.append((name, "failed"))
    return found


def main(paths: list[str]) -> int:
    everything = [outcome for path in paths for outcome in outcomes(Path(path))]
    skipped = [name for name, outcome in everything if outcome == "skipped"]
    failed = [name for name, outcome in everything if outcome == "failed"]
    passed = len(everything) - len(failed) - len(skipped)
    for title, names in (("Skipped", skipped), ("Failed", failed)):
        if names:
            print(f"{title}:")
            print("".join(f"    {name}\n" for name in names), end="")
    print(f"{passed} passed, {len(failed)} failed, {len(skipped)} skipped")
    return 1 if failed or passed == 0 else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
