# SPDX-License-Identifier: GPL-3.0-or-later
"""One file of a batch run: from its job to its report, whatever happens to Blender on the way."""

import hashlib
import json
import os
import shutil
import signal
import tempfile
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from .. import locked_folder, run_report
from ..exit_codes import STATUS, ExitCode
from ..file_names import fitting
from ..locked_folder import LockedFolder
from ..problems import ERROR, Problem
from ..store import store_path
from . import blend_header, earlier_runs, input_stamps, png_check
from .child_log import ChildLog
from .child_process import CANCELLED, Child
from .earlier_runs import Found
from .file_jobs import FileJob
from .verbs import verb_of

CRASH, NOT_BEGUN = "crash", "not_begun"
PROGRESS = "Lodestone: progress: "
JOB_FOLDER = "lodestone-job"
# jemalloc, in Debian's Blender: the kernel gives a large scene's memory in pages of 2 MB, not 4 kB.
_LARGE_PAGES = "thp:always"
_QUIET = (ExitCode.DONE, ExitCode.CANCELLED)  # their logs say nothing


@dataclass(frozen=True)
class Limits:
    """The limits of each file: seconds, and bytes of all its processes. None: no limit."""

    timeout_s: float | None = None
    max_bytes: int | None = None


@dataclass
class Surroundings:
    """The surroundings that all tasks of a run share. `record(line, **values)` adds to the log;
    `said(task, text)` takes progress, `began(task)` and `done(task)` its beginning and end."""

    blender: str
    script: Path  # batch_blender/file_run.py
    limits: Limits
    skip_existing: bool
    files: Path | None  # folder of logs and thumbnails; None: logs beside the levels
    record: Callable[..., None]
    said: Callable[["FileTask", str], None]
    began: Callable[["FileTask"], None]
    done: Callable[["FileTask"], None]


@dataclass(eq=False)
class FileTask:
    """The task of one file. `report` is there after start() returned None or after finish()."""

    number: int
    job: FileJob
    found: Found
    around: Surroundings
    report: dict[str, Any] = field(default_factory=dict)
    _made: dict[str, dict[str, Any]] = field(default_factory=dict)
    _inputs: dict[str, Any] | None = None
    _read: int = 0

    # ---- Before ----

    def start(self) -> Child | None:
        self.around.began(self)
        self._began = time.monotonic()
        job = self.job
        program = shutil.which(self.around.blender)
        if program is None:
            text = f"Blender was not found ({self.around.blender}): install it, or name it with "
            self._refuse(ExitCode.FAILED, text + "--blender")
            return None
        if not os.path.isfile(job.file) or not os.access(job.file, os.R_OK):
            reason = "cannot be read" if os.path.exists(job.file) else "does not exist"
            if os.path.isdir(job.file):
                reason = "is a folder"
            self._refuse(ExitCode.UNREADABLE, f"the file {reason}")
            return None
        carried = dict(self.found.pictures)
        if self.around.skip_existing:
            for _, picture in job.wanted():
                if picture.out not in carried and png_check.is_whole(picture.out):
                    carried[picture.out] = {"picture": picture.out, "skipped": True}
        self._carried = carried
        if carried and all(picture.out in carried for _, picture in job.wanted()):
            self._end(run_report.file_report(job.verb, job.file, ExitCode.DONE))
            return None
        self._store = store_path.store_folder(job.file, job.store)
        self._settle(keep=False)
        self._clear_temporaries()
        try:
            return self._start_child(program)
        except OSError as error:
            self._refuse(ExitCode.FAILED, f"Blender cannot be started: {error}")
            return None

    def _start_child(self, program: str) -> Child:
        temporary = Path(tempfile.gettempdir())
        self._folder = LockedFolder(temporary, JOB_FOLDER)
        place = self._folder.path
        self._log = ChildLog(place / "log")
        job = replace(
            self.job,
            report=str(place / "report.json"),
            skip=tuple(self._carried),
            thumbnail=str(place / "thumbnail.jpg") if self.around.files else "",
            supervisor=os.getpid(),
        )
        try:
            (place / "job.json").write_text(job.dump(), "utf-8")
            command = [
                program,
                "--background",
                "--factory-startup",
                "--enable-autoexec" if job.trust_scripts else "--disable-autoexec",
                "--python-exit-code",
                "1",
                "--python",
                str(self.around.script),
                "--",
                str(place / "job.json"),
            ]
            self._child = Child(
                command,
                _environment(os.environ, place),
                self._log,
                self._hear,
                self.around.limits.timeout_s,
                self.around.limits.max_bytes,
            )
        except BaseException:
            self._log.close()
            self._folder.remove()
            raise
        return self._child

    def _settle(self, keep: bool) -> None:
        """Scene folders whose Blender did not live to see to them."""
        scene = store_path.scene_folder(self._store)
        locked_folder.settle(scene.parent, scene.name, keep)

    def _clear_temporaries(self) -> None:
        """Pictures that a killed Blender was writing."""
        for folder in {os.path.dirname(picture.out) for picture in self.job.pictures}:
            try:
                names = os.listdir(folder)
            except OSError:
                continue
            for name in names:
                owner = run_report.temporary_owner(name)
                if owner and not os.path.exists(f"/proc/{owner}"):
                    Path(folder, name).unlink(missing_ok=True)

    def _refuse(self, code: ExitCode, text: str) -> None:
        self._carried = dict(self.found.pictures)
        self._end(run_report.file_report(self.job.verb, self.job.file, code, text))

    def leave(self) -> None:
        """It is not begun: the run was interrupted before."""
        made = run_report.file_report(self.job.verb, self.job.file, ExitCode.CANCELLED, "not begun")
        self._began, self._carried = time.monotonic(), dict(self.found.pictures)
        self._end({**made, "cause": NOT_BEGUN})

    # ---- While it runs ----

    def _hear(self, line: str) -> None:
        if line.startswith(PROGRESS):
            self.around.said(self, line[len(PROGRESS) :])

    def look(self) -> None:
        """Takes over what is finished, before anything can happen to the rest."""
        try:
            with open(self._folder.path / run_report.EVENTS, "rb") as file:
                file.seek(self._read)
                lines = file.read().split(b"\n")[:-1]  # the last one is not whole yet
        except OSError:
            return
        for line in lines:
            self._read += len(line) + 1
            try:
                self._event(json.loads(line))
            except (ValueError, KeyError, TypeError):
                continue

    def _event(self, event: dict[str, Any]) -> None:
        file = self.job.file
        if "inputs" in event:
            inputs: dict[str, Any] = event["inputs"]
            self._inputs = inputs
            name = input_stamps.identity(inputs)
            self.around.record("inputs", id=name, file=file, inputs=inputs)
        elif "made" in event:
            out, made = event["out"], event["made"]
            self._made[out] = made
            if self.job.many_pictures and self._inputs is not None:
                wanted = (w for w in self.job.wanted() if w[1].out == out)
                self.around.record(
                    "picture",
                    file=file,
                    key=self.job.picture_key(*next(wanted)),
                    inputs=input_stamps.identity(self._inputs),
                    out=out,
                    outputs=earlier_runs.outputs(verb_of(self.job.verb).results(made)),
                    made=made,
                )

    # ---- Afterwards ----

    def finish(self) -> None:
        self.look()
        child, job = self._child, self.job
        written = _written(self._folder.path / "report.json")
        if child.cause:
            code = ExitCode.CANCELLED if child.cause == CANCELLED else ExitCode.FAILED
            made = run_report.file_report(job.verb, job.file, code, child.explanation)
            made = {**written, **made, "cause": child.cause}
        elif written:
            made = written
        else:
            made = self._crashed(child.returncode)
        code = ExitCode(made["exit_code"])
        failed = code not in (ExitCode.DONE, ExitCode.INCOMPLETE, ExitCode.CANCELLED)
        self._settle(keep=failed and job.keep != "never")
        for path in self._folder.path.glob("*.crash.txt"):
            self._log.add_file(path)
        self._log.close()
        if code not in _QUIET:
            made["log"] = self._keep("log", ".log") or ""
        elif code == ExitCode.DONE:
            self._place(".log").unlink(missing_ok=True)  # the log of an earlier failure
        thumbnail = self._keep("thumbnail.jpg", ".jpg")
        if thumbnail:
            made["thumbnail"] = thumbnail
        made["memory"] = {**made.get("memory", {}), "peak_bytes": child.peak_bytes}
        self._folder.remove()
        self._end(made)

    def _crashed(self, returncode: int | None) -> dict[str, Any]:
        how = f"exit code {returncode}"
        if returncode is not None and returncode < 0:
            how = f"signal {_signal_name(-returncode)}"
        file = self.job.file
        text = f"Blender died on the file ({how}){blend_header.written_by(file)}"
        made = run_report.file_report(self.job.verb, file, ExitCode.UNREADABLE, text)
        return {**made, "cause": CRASH, "log_tail": self._log.last_lines}

    def _keep(self, name: str, suffix: str) -> str | None:
        """Moves a file out of the job's folder to where the user finds it."""
        source, target = self._folder.path / name, self._place(suffix)
        if not source.is_file():
            return None
        try:
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.move(source, target)
        except OSError:
            return None
        return str(target)

    def _place(self, suffix: str) -> Path:
        if self.around.files is None:
            return self._store.with_name(self._store.name + suffix)
        key = hashlib.blake2b(os.fsencode(self.job.file), digest_size=4).hexdigest()
        return self.around.files / f"{fitting(Path(self.job.file).stem, 200)}-{key}{suffix}"

    def _end(self, made: dict[str, Any]) -> None:
        """Completes the report by what was there before, and tells of it."""
        job = self.job
        every = {**self._carried, **self._made}
        _take_over_problems(job, made, every)
        if job.many_pictures:
            pictures = [
                {**({} if frame is None else {"frame": frame}), **every[picture.out]}
                for frame, picture in job.wanted()
                if picture.out in every
            ]
            if pictures:
                made["pictures"] = pictures
        elif every and "cut" not in made:  # it was there, or Blender died right after it
            made.update(next(iter(every.values())))
        if self.found.pictures:
            made["resumed"] = len(self.found.pictures)
        made["wall_s"] = round(time.monotonic() - self._began, 3)
        self.report = made
        inputs = input_stamps.identity(self._inputs) if self._inputs is not None else ""
        self.around.record(
            "file",
            file=job.file,
            key=job.key(),
            inputs=inputs,
            outputs=earlier_runs.outputs(verb_of(job.verb).results(made)),
            report={k: v for k, v in made.items() if k != "log_tail"},
        )
        self.around.done(self)
        made.pop("log_tail", None)


def _take_over_problems(
    job: FileJob, made: dict[str, Any], pictures: dict[str, dict[str, Any]]
) -> None:
    """Takes over the problems of pictures that are not in this Blender's report: they count all the
    same."""
    problems = made.setdefault("problems", [])
    known = {(problem["object"], problem["code"]) for problem in problems}
    for out, picture in pictures.items():
        pictures[out] = {key: value for key, value in picture.items() if key != "problems"}
        for problem in picture.get("problems", ()):
            if (problem["object"], problem["code"]) not in known:
                known.add((problem["object"], problem["code"]))
                problems.append(problem)
    wrong = [Problem(**problem) for problem in problems if problem["severity"] == ERROR]
    if wrong and made["exit_code"] == ExitCode.DONE:
        code = ExitCode.FAILED if job.strict else ExitCode.INCOMPLETE
        text = f"the picture is incomplete: {wrong[0].sentence}"
        made.update(run_report.file_report(job.verb, job.file, code, text))


def _signal_name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:  # most real-time signals have none
        return str(number)


def _written(path: Path) -> dict[str, Any]:
    """The report of the half inside Blender; {} when it wrote none."""
    try:
        value = json.loads(path.read_text("utf-8"))
    except (OSError, ValueError):
        return {}
    return value if isinstance(value, dict) and value.get("exit_code") in STATUS else {}


def _environment(ours: Mapping[str, str], place: Path) -> dict[str, str]:
    """Blender's: its own temporary files and crash report go to `place`, and are removed with ours;
    how it asks for memory is left as it is where `ours` says it."""
    return {"MALLOC_CONF": _LARGE_PAGES, **ours, "TMPDIR": str(place)}
