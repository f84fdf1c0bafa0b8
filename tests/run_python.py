# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs unittest files and writes what happened as JUnit XML, in plain Python or inside Blender.

    python3 tests/run_python.py --junit OUT.xml FILE...
    blender -b --factory-startup --python-exit-code 1 --python tests/run_python.py \\
        -- --junit OUT.xml FILE...

Exit code 0 when every test of every file passed or was skipped. A file that cannot be imported,
or that holds no test, counts as one failed test: nothing is lost silently.
"""

import argparse
import importlib.util
import os
import sys
import time
import traceback
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path


class Recorder(unittest.TextTestResult):
    """Keeps (name, outcome, message, seconds) of every test; a failed subtest fails its test."""

    def __init__(self, *arguments, **keywords):
        super().__init__(*arguments, **keywords)
        self.records: list[list] = []
        self.started = 0.0

    def startTest(self, test):
        super().startTest(test)
        self.started = time.monotonic()
        self.records.append([test.id(), "passed", "", 0.0])

    def stopTest(self, test):
        super().stopTest(test)
        self.records[-1][3] = time.monotonic() - self.started

    def record(self, test, outcome, message):
        name = test.id()
        if self.records and name.startswith(self.records[-1][0]):  # the test or a subtest of it
            if self.records[-1][1] != "failed":
                self.records[-1][1] = outcome
            self.records[-1][2] = "\n".join(filter(None, (self.records[-1][2], message)))
        else:  # setUpClass and the like: there is no test to put it on
            self.records.append([name, outcome, message, 0.0])

    def addFailure(self, test, err):
        super().addFailure(test, err)
        self.record(test, "failed", self.failures[-1][1])

    def addError(self, test, err):
        super().addError(test, err)
        self.record(test, "failed", self.errors[-1][1])

    def addSubTest(self, test, subtest, err):
        super().addSubTest(test, subtest, err)
        if err is not None:
            self.record(subtest, "failed", "".join(traceback.format_exception(*err)))

    def addSkip(self, test, reason):
        super().addSkip(test, reason)
        self.record(test, "skipped", reason)

    def addUnexpectedSuccess(self, test):
        super().addUnexpectedSuccess(test)
        self.record(test, "failed", "passed, but is marked as an expected failure")


def load(path: Path) -> unittest.TestSuite:
    """The tests of one file, imported under its own name with its folder on the path."""
    sys.path.insert(0, str(path.parent))
    specification = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(specification)
    sys.modules[path.stem] = module
    specification.loader.exec_module(module)
    suite = unittest.defaultTestLoader.loadTestsFromModule(module)
    if suite.countTestCases() == 0:
        raise ValueError(f"{path.name} holds no test")
    return suite


def write_junit(path: Path, suite: str, records: list[list]) -> None:
    root = ElementTree.Element("testsuite", name=suite, tests=str(len(records)))
    for name, outcome, message, seconds in records:
        case = ElementTree.SubElement(root, "testcase", name=name, time=f"{seconds:.3f}")
        if outcome != "passed":
            tag = "failure" if outcome == "failed" else "skipped"
            # XML 1.0 cannot hold control characters, and a message may quote any output.
            text = "".join(c if c.isprintable() or c in "\n\t" else "?" for c in message)
            ElementTree.SubElement(case, tag, message=text.strip().split("\n")[-1]).text = text
    path.parent.mkdir(parents=True, exist_ok=True)
    ElementTree.ElementTree(root).write(path, encoding="utf-8", xml_declaration=True)


def run_file(file: Path) -> list[list]:
    """The records of all tests of one file."""
    try:
        suite = load(file.resolve())
    except unittest.SkipTest as skip:
        return [[f"{file.stem} (whole file)", "skipped", str(skip), 0.0]]
    except BaseException:  # also a file that calls sys.exit while it is imported
        print(traceback.format_exc(), flush=True)
        return [[f"{file.stem} (import)", "failed", traceback.format_exc(), 0.0]]
    runner = unittest.TextTestRunner(stream=sys.stdout, verbosity=2, resultclass=Recorder)
    return runner.run(suite).records


def run(files: list[Path], junit: Path) -> bool:
    """Runs all files in order. True if nothing failed."""
    # Written again after every file: when one takes the process down, it and those after it are
    # on record as failed.
    records = {file: [[f"{file.stem} (did not finish)", "failed", "", 0.0]] for file in files}
    for file in files:
        write_junit(junit, junit.stem, sum(records.values(), []))
        print(f"==== {file}", flush=True)
        records[file] = run_file(file)
    everything = sum(records.values(), [])
    write_junit(junit, junit.stem, everything)
    return all(outcome != "failed" for _, outcome, _, _ in everything)


def main() -> int:
    arguments = sys.argv[1:]
    inside_blender = "bpy" in sys.modules or "--" in arguments
    if inside_blender:
        arguments = arguments[arguments.index("--") + 1 :]
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--junit", type=Path, required=True)
    parser.add_argument("files", type=Path, nargs="+")
    options = parser.parse_args(arguments)
    sys.argv = [sys.argv[0]]
    passed = run(options.files, options.junit)
    if inside_blender:
        # Blender would go on and might crash while it closes; the result is known now.
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(0 if passed else 1)
    return 0 if passed else 1


if __name__ == "__main__":
    sys.exit(main())
