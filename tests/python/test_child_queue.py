# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards supervising: time, memory, Ctrl-C, and that no process is left whatever happens."""

import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import addon_path
from lodestone.core.batch import child_process, process_session
from lodestone.core.batch.child_log import ChildLog
from lodestone.core.batch.child_process import Child
from lodestone.core.batch.child_queue import Interrupts, Queue

GREEDY = "x = bytearray(150 << 20); import time; time.sleep(60)"


def living(pid):
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] not in "ZX"
    except OSError:
        return False


def gone(pid, seconds=5.0):
    end = time.monotonic() + seconds
    while living(pid) and time.monotonic() < end:
        time.sleep(0.01)
    return not living(pid)


class Command:
    """A task that runs a shell's text."""

    def __init__(self, text, folder, **limits):
        self.text, self.folder, self.limits = text, folder, limits
        self.lines, self.child, self.looked = [], None, 0

    def start(self):
        log = ChildLog(self.folder / f"{id(self)}.log")
        command = ["/bin/sh", "-c", self.text]
        self.child = Child(command, dict(os.environ), log, self.lines.append, **self.limits)
        return self.child

    def look(self):
        self.looked += 1

    def finish(self):
        self.child.log.close()


class Supervised(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def run_all(self, *commands, slots=1, **limits):
        tasks = [Command(text, self.folder, **limits) for text in commands]
        with Interrupts() as interrupts:
            self.left = Queue(tasks, slots, interrupts).run()
        return tasks

    def test_nothing_to_do_is_done(self):
        self.assertEqual(self.run_all(), [])

    def test_what_it_says_and_how_it_ends(self):
        (task,) = self.run_all("echo one; printf two >&2; sleep 0.2; exit 7")
        self.assertEqual((task.lines, task.child.returncode), (["one", "two"], 7))
        self.assertEqual(task.child.cause, "")
        self.assertGreater(task.child.peak_bytes, 100_000)

    def test_a_signal_is_a_negative_code(self):
        (task,) = self.run_all("kill -SEGV $$")
        self.assertEqual(task.child.returncode, -signal.SIGSEGV)

    def test_several_run_at_once_and_no_more_than_asked(self):
        log = self.folder / "order"
        text = f"echo + >> {log}; sleep 0.2; echo - >> {log}"
        self.run_all(*[text] * 6, slots=3)
        running = most = 0
        for line in log.read_text().split():
            running += 1 if line == "+" else -1
            most = max(most, running)
        self.assertEqual((running, most), (0, 3))

    def test_one_that_takes_too_long_is_stopped_with_all_it_started(self):
        text = f"trap '' TERM; sleep 60 & echo $! > {self.folder}/pid; while :; do sleep 1; done"
        start = time.monotonic()
        (task,) = self.run_all(text, timeout_s=0.3)
        self.assertLess(time.monotonic() - start, 4.0)
        self.assertEqual(task.child.cause, child_process.TIMEOUT)
        self.assertIn("0.3 s of --timeout", task.child.explanation)
        self.assertTrue(gone((self.folder / "pid").read_text().strip()))

    def test_one_that_takes_too_much_memory_is_stopped_and_says_how_much(self):
        # Not the child itself: another process group of its session, as POV-Ray is.
        text = f"setsid -w true; {sys.executable} -c '{GREEDY}' & echo $! > {self.folder}/pid; wait"
        (task,) = self.run_all(text, max_bytes=100 << 20)
        self.assertEqual(task.child.cause, child_process.MEMORY)
        self.assertRegex(task.child.explanation, r"stopped at 1\d\d MB .*105 MB of --max-memory")
        self.assertRegex(task.child.explanation, r"python\S* 1\d\d MB")
        self.assertGreater(task.child.peak_bytes, 100 << 20)
        self.assertTrue(gone((self.folder / "pid").read_text().strip()))

    def test_a_process_group_of_its_own_is_no_way_out(self):
        text = f"set -m; sleep 60 & echo $! > {self.folder}/pid; exit 0"
        (task,) = self.run_all(text)
        self.assertEqual(task.child.returncode, 0)
        self.assertTrue(gone((self.folder / "pid").read_text().strip()))

    def test_a_flood_of_text_is_bounded_and_keeps_its_ends(self):
        (task,) = self.run_all("echo first; yes | head -c 6000000; echo last")
        log = (self.folder / f"{id(task)}.log").read_bytes()
        self.assertLess(len(log), 5 << 20)
        self.assertTrue(log.startswith(b"first\n"))
        self.assertTrue(log.endswith(b"y\nlast\n"))
        self.assertIn(b"bytes left out", log)
        self.assertTrue(task.child.log.last_lines.endswith("last\n"))

    def test_a_line_without_end_is_no_reason_to_take_all_memory(self):
        (task,) = self.run_all("head -c 3000000 /dev/zero; echo")
        self.assertEqual(sum(map(len, task.lines)), 3000000)
        self.assertGreater(len(task.lines), 20)

    def test_an_error_of_ours_leaves_nothing_running(self):
        class Broken(Command):
            def look(self):
                raise ZeroDivisionError

        task = Broken("sleep 60", self.folder)
        with Interrupts() as interrupts, self.assertRaises(ZeroDivisionError):
            Queue([task], 1, interrupts).run()
        self.assertTrue(gone(task.child.pid))

    def test_ctrl_c_stops_all_within_a_second_and_begins_no_more(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            text = f"trap '' TERM; while :; do sleep 0.2; kill -{int(number)} {os.getpid()}; done"
            start = time.monotonic()
            tasks = self.run_all("trap '' TERM; sleep 60; sleep 60", text, "sleep 60", slots=2)
            self.assertLess(time.monotonic() - start, 3.0)
            self.assertEqual([task.child.cause for task in tasks[:2]], ["cancelled"] * 2)
            self.assertEqual(self.left, tasks[2:])
            self.assertTrue(all(gone(task.child.pid) for task in tasks[:2]))


class KilledSupervisor(unittest.TestCase):
    SCRIPT = """
import os, sys
from pathlib import Path
import addon_path
from test_child_queue import Command
from lodestone.core.batch.child_queue import Interrupts, Queue
folder = Path(sys.argv[1])
with Interrupts() as interrupts:
    Queue([Command(f"echo $$ > {folder}/pid; exec sleep 60", folder)], 1, interrupts).run()
"""

    def test_its_children_die_with_it(self):
        with tempfile.TemporaryDirectory() as folder:
            here = str(Path(addon_path.__file__).parent)
            environment = {**os.environ, "PYTHONPATH": here}
            command = [sys.executable, "-c", self.SCRIPT, folder]
            supervisor = subprocess.Popen(command, env=environment)
            pid = Path(folder, "pid")
            end = time.monotonic() + 20
            while not (pid.is_file() and pid.read_text().strip()) and time.monotonic() < end:
                time.sleep(0.01)
            self.assertTrue(living(pid.read_text().strip()))
            supervisor.kill()
            supervisor.wait()
            self.assertTrue(gone(pid.read_text().strip(), 1.0))


class Sessions(unittest.TestCase):
    def test_a_name_like_a_field_does_not_hide_a_process(self):
        with tempfile.TemporaryDirectory() as folder:
            program = Path(folder, ") S 1 1 1 (")
            program.symlink_to("/bin/sleep")
            child = subprocess.Popen([str(program), "60"], start_new_session=True)
            try:
                time.sleep(0.1)
                self.assertEqual(process_session.sessions([child.pid])[child.pid], [child.pid])
                (member,) = process_session.measure([child.pid])
                self.assertEqual((member.pid, member.name), (child.pid, ") S 1 1 1 ("))
            finally:
                process_session.kill(child.pid)
                child.wait()
            self.assertEqual(process_session.sessions([child.pid])[child.pid], [])

    def test_a_killed_processs_log_is_not_empty(self):
        text = (
            "import ctypes, os, signal; from lodestone.core.batch import process_session\n"
            "c = ctypes.CDLL(None); c.printf(b'before\\n'); process_session.speak_in_lines()\n"
            "c.printf(b'after\\n'); os.kill(os.getpid(), signal.SIGKILL)"
        )
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
        command = [sys.executable, "-c", text]
        done = subprocess.run(command, env=environment, capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout), (-signal.SIGKILL, "before\nafter\n"))


if __name__ == "__main__":
    unittest.main()
