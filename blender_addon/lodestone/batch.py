# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds, renders and exports .blend files without a window: a Blender of its own for each file.

    /usr/bin/python3 batch.py build|render|export FILE... [options]

This half runs in plain Python and outlives whatever happens to Blender; the other half is
batch_blender.py. A crash, a signal and a missing report all become exit codes.
"""

import os
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent
GRACE_S = 5.0  # for Blender to stop by itself, before it is killed
LOG_TAIL = 20
PROGRESS = "Lodestone: progress: "
SPOKEN = "Lodestone: "


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

from lodestone.core import report  # noqa: E402
from lodestone.core.batch_arguments import FileJob, jobs, parser  # noqa: E402
from lodestone.core.exit_codes import STATUS, ExitCode, of_many  # noqa: E402
from lodestone.core.problems import Problem  # noqa: E402


class Cancelled(Exception):
    """Ctrl-C or SIGTERM."""


def main(arguments: list[str]) -> int:
    top = parser()
    options = top.parse_args(arguments)
    try:
        work = jobs(options)
    except ValueError as error:
        top.error(str(error))  # exits 2
    signal.signal(signal.SIGTERM, _cancel)
    signal.signal(signal.SIGINT, _cancel)
    blender = options.blender or os.environ.get("LODESTONE_BLENDER") or "blender"
    reports, codes = [], []
    for number, job in enumerate(work):
        if len(work) > 1:
            print(f"[{number + 1}/{len(work)}] {job.file}", flush=True)
        result = run_file(job, blender, options.timeout)
        reports.append(result)
        codes.append(ExitCode(result["exit_code"]))
        speak(result)
        if codes[-1] == ExitCode.CANCELLED:
            break
    code = of_many(codes)
    if options.json:
        whole = reports[0] if len(work) == 1 else report.many_report(options.verb, reports, code)
        try:
            report.write(options.json, whole)
        except OSError as error:
            print(f"batch.py: the report cannot be written: {error}", file=sys.stderr)
            code = ExitCode.FAILED if code == ExitCode.DONE else code
    return int(code)


def speak(result: dict) -> None:
    """One line on how it went, and each problem once."""
    for problem in result.get("problems", []):
        if problem["severity"] != "info":
            print(f"{problem['severity']}: {Problem(**problem).sentence}", file=sys.stderr)
    if "message" in result:
        print(f"batch.py: {result['input']}: {result['message']}", file=sys.stderr)
    for picture in result.get("pictures", [result]):
        if picture.get("picture"):
            print(picture["picture"])
    sys.stdout.flush()


def run_file(job: FileJob, blender: str, timeout: float | None) -> dict:
    """Runs one job in a Blender of its own; returns its report, whatever happened."""
    program = shutil.which(blender)
    if program is None:
        text = f"Blender was not found ({blender}): install it, or name it with --blender"
        return report.file_report(job.verb, job.file, ExitCode.FAILED, text)
    if not os.path.isfile(job.file) or not os.access(job.file, os.R_OK):
        reason = "cannot be read" if os.path.exists(job.file) else "does not exist"
        return report.file_report(job.verb, job.file, ExitCode.UNREADABLE, f"the file {reason}")
    with tempfile.TemporaryDirectory(prefix="lodestone-") as folder:
        place = Path(folder)
        job = FileJob(**{**job.__dict__, "report": str(place / "report.json")})
        (place / "job.json").write_text(job.dump(), "utf-8")
        command = [
            program,
            "--background",
            "--factory-startup",
            "--disable-autoexec",
            "--python-exit-code",
            "1",
            "--python",
            str(PACKAGE / "batch_blender.py"),
            "--",
            str(place / "job.json"),
        ]
        return _supervise(command, job, timeout, place / "report.json")


def _supervise(command: list[str], job: FileJob, timeout: float | None, result: Path) -> dict:
    tail: list[str] = []
    try:
        child = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            start_new_session=True,  # Ctrl-C reaches us alone; the child and its POV-Ray get ours
        )
    except OSError as error:
        text = f"Blender cannot be started: {error}"
        return report.file_report(job.verb, job.file, ExitCode.FAILED, text)
    reader = threading.Thread(target=_relay, args=(child.stdout, tail), daemon=True)
    reader.start()
    code, message = None, ""
    try:
        child.wait(timeout)
    except subprocess.TimeoutExpired:
        code, message = ExitCode.FAILED, f"stopped after the {timeout:g} s of --timeout"
        _stop(child)
    except Cancelled:
        code, message = ExitCode.CANCELLED, "cancelled"
        _stop(child)
    _kill_group(child)  # nothing of the child's may outlive it
    reader.join(2.0)
    written = _read(result)
    if code is not None:
        return {**written, **report.file_report(job.verb, job.file, code, message)}
    if written:
        return written
    how = f"exit code {child.returncode}"
    if child.returncode < 0:
        how = f"signal {signal.Signals(-child.returncode).name}"
    print("".join(tail), file=sys.stderr)
    text = f"Blender died on the file ({how}); the end of its log is above"
    return report.file_report(job.verb, job.file, ExitCode.UNREADABLE, text)


def _relay(stream, tail: list[str]) -> None:
    """Passes on what our half in Blender says; keeps the end of everything for a crash."""
    terminal = sys.stdout.isatty()
    shown = False
    for raw in stream:
        line = raw.decode("utf-8", "replace")
        if line.startswith(PROGRESS):
            if terminal:
                print(f"\r\x1b[K{line[len(PROGRESS):].rstrip()}", end="", flush=True)
                shown = True
            continue
        if shown:
            print("\r\x1b[K", end="", flush=True)
            shown = False
        if line.startswith(SPOKEN):
            print(line[len(SPOKEN) :], end="", flush=True)
        tail.append(line)
        del tail[:-LOG_TAIL]
    if shown:
        print("\r\x1b[K", end="", flush=True)


def _read(path: Path) -> dict:
    import json

    try:
        value = json.loads(path.read_text("utf-8"))
    except (OSError, ValueError):
        return {}
    return value if isinstance(value, dict) and value.get("exit_code") in STATUS else {}


def _stop(child: subprocess.Popen) -> None:
    """Asks it to stop, so that it clears up; kills it when it does not."""
    child.terminate()
    end = time.monotonic() + GRACE_S
    while child.poll() is None and time.monotonic() < end:
        try:
            time.sleep(0.05)
        except Cancelled:  # asked twice: now
            break
    _kill_group(child)
    child.wait()


def _kill_group(child: subprocess.Popen) -> None:
    try:
        os.killpg(child.pid, signal.SIGKILL)
    except (ProcessLookupError, PermissionError):
        pass


def _cancel(number, frame) -> None:
    raise Cancelled


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except Cancelled:
        sys.exit(int(ExitCode.CANCELLED))
