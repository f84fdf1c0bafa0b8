# SPDX-License-Identifier: GPL-3.0-or-later
"""Works on .blend files without a window: a Blender of its own for each file.

    /usr/bin/python3 batch.py VERB FILE... [options]        (--help lists the verbs)

This half runs in plain Python and outlives whatever happens to Blender; the other half is
batch_blender/. A crash, a signal and a missing report all become exit codes.
"""

import os
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent
PAGE_EVERY_S = 10.0


def hand_over() -> None:
    """From a checkout: goes on as the staged add-on, which has the library. Exits 2 without one."""
    if (PACKAGE / "lodestone_native").is_dir():
        return
    root = PACKAGE.parents[1]
    stage = Path(os.environ.get("LODESTONE_STAGE") or root / "build" / "release" / "stage")
    staged = stage / "addons" / "lodestone" / "batch.py"
    if not staged.is_file():
        print(
            f"batch.py: the add-on is not built ({staged} is missing); build it with:\n"
            f"    cd {root} && cmake --preset release && cmake --build --preset release",
            file=sys.stderr,
        )
        sys.exit(2)
    sys.stdout.flush()
    os.execv(sys.executable, [sys.executable, str(staged), *sys.argv[1:]])


if __name__ == "__main__":
    hand_over()
    # The package, not its folder: a module here must not hide one of Python's.
    sys.path[0] = str(PACKAGE.parent)

from lodestone import bl_info  # noqa: E402
from lodestone.core import locked_folder, run_report  # noqa: E402
from lodestone.core.batch import html_page, run_log  # noqa: E402
from lodestone.core.batch.child_queue import Interrupts, Queue  # noqa: E402
from lodestone.core.batch.command_line import jobs, parse, parser  # noqa: E402
from lodestone.core.batch.earlier_runs import Earlier, Found  # noqa: E402
from lodestone.core.batch.file_jobs import FileJob  # noqa: E402
from lodestone.core.batch.file_task import JOB_FOLDER, FileTask, Limits, Surroundings  # noqa: E402
from lodestone.core.batch.report_rows import rows_of, table, tally  # noqa: E402
from lodestone.core.batch.run_console import Console  # noqa: E402
from lodestone.core.exit_codes import ExitCode, of_many  # noqa: E402


class Interrupted(Exception):
    """While nothing ran yet."""


class Run:
    """All files of one call."""

    def __init__(self, options, work: list[FileJob], interrupts: Interrupts) -> None:
        self.options = options
        self.work = work
        self.interrupts = interrupts
        self.console = Console(len(work))
        self.reports: dict[int, dict] = {}
        self.log: run_log.BatchLog | None = None
        self.unwritten: set[str] = set()  # names of what could not be written
        self._page_at = 0.0
        beside = options.log or options.html
        files = Path(beside).absolute().with_suffix(".files") if beside else None
        self.around = Surroundings(
            blender=options.blender or os.environ.get("LODESTONE_BLENDER") or "blender",
            script=PACKAGE / "batch_blender" / "file_run.py",
            limits=Limits(options.timeout, options.max_memory),
            skip_existing=getattr(options, "skip_existing", False),
            files=files,
            record=self._record,
            said=lambda task, text: self.console.progress(task.number, task.job.file, text),
            began=lambda task: self.console.began(task.number, task.job.file),
            done=self._done,
        )

    def run(self) -> ExitCode:
        locked_folder.settle(Path(tempfile.gettempdir()), JOB_FOLDER)  # of killed runs
        earlier = Earlier(run_log.read(self.options.log) if self.options.resume else ())
        if self.options.log:
            self.log = run_log.BatchLog(self.options.log)
            started = time.strftime("%Y-%m-%dT%H:%M:%S%z")
            verb, files = self.options.verb, len(self.work)
            self._record("run", verb=verb, files=files, time=started)
        tasks = self._tasks(earlier)
        for task in Queue(tasks, self.options.jobs, self.interrupts).run():
            task.leave()
        code = of_many(made["exit_code"] for made in self._in_order())
        if self.options.json:
            self._write(run_report.write, self.options.json, self._whole(code), "report")
        self._write_page()
        if len(self.work) > 1:
            rows = rows_of(self._in_order())
            print(f"\n{table(rows)}\n{tally(rows)}", flush=True)
        return ExitCode.FAILED if self.unwritten and code == ExitCode.DONE else code

    def _tasks(self, earlier: Earlier) -> list[FileTask]:
        """Those that are left to do; the reports of the others are taken over."""
        tasks = []
        for number, job in enumerate(self.work):
            try:
                found = earlier.find(job, self._tick)
            except Interrupted:
                found = Found()
            if found.report is not None:
                self.reports[number] = {**found.report, "resumed": True}
                self.console.finished(number, self.reports[number])
            else:
                tasks.append(FileTask(number, job, found, self.around))
        return tasks

    def _tick(self) -> None:
        if self.interrupts.count:
            raise Interrupted

    def _done(self, task: FileTask) -> None:
        self.reports[task.number] = task.report
        self.console.finished(task.number, task.report)
        if time.monotonic() - self._page_at > PAGE_EVERY_S:
            self._write_page()
            self._page_at = time.monotonic()

    def _record(self, line: str, **values) -> None:
        if self.log is None:
            return
        try:
            self.log.add(line, **values)
        except OSError as error:
            self._complain("log", error)
            self.log.close()
            self.log = None

    # ---- What is written ----

    def _in_order(self) -> list[dict]:
        return [self.reports[number] for number in sorted(self.reports)]

    def _whole(self, code: ExitCode) -> dict:
        if len(self.work) == 1:
            return self.reports[0]
        return run_report.many_report(self.options.verb, self._in_order(), code)

    def _write_page(self) -> None:
        if not self.options.html:
            return
        reports = self._in_order()
        title = f"Lodestone: {self.options.verb}"
        about = time.strftime("%Y-%m-%d %H:%M:%S %z")
        left = len(self.work) - len(reports)
        page = html_page.page(rows_of(reports), title, about, Path(self.options.html), left)
        self._write(html_page.write, self.options.html, page, "page")

    def _write(self, write, path: str, value, name: str) -> None:
        try:
            write(path, value)
        except OSError as error:
            self._complain(name, error)

    def _complain(self, name: str, error: OSError) -> None:
        if name not in self.unwritten:  # the page is tried again and again
            text = f"batch.py: the {name} cannot be written: {error.strerror or error}"
            self.console.line(text, error=True)
            self.unwritten.add(name)


def main(arguments: list[str]) -> int:
    options = parse(arguments)
    if options.jobs > 1 and options.threads == 0:
        options.threads = max(1, len(os.sched_getaffinity(0)) // options.jobs)
    version = ".".join(str(part) for part in bl_info["version"])
    try:
        work = [replace(job, version=version) for job in jobs(options)]
    except ValueError as error:
        parser().error(str(error))  # exits 2
    with Interrupts() as interrupts:
        try:
            return int(Run(options, work, interrupts).run())
        except OSError as error:
            print(f"batch.py: {error}", file=sys.stderr)
            return int(ExitCode.FAILED)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
