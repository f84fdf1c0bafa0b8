# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards temporary folders: a living owner's is left alone, a dead one's is found."""

import fcntl
import itertools
import os
import signal
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import addon_path
from lodestone.core import locked_folder
from lodestone.core.locked_folder import LockedFolder
from lodestone.core.picture.picture_maker import SceneFolder

DYING = """
import os, sys
from pathlib import Path
import addon_path
from lodestone.core.locked_folder import LockedFolder
folder = LockedFolder(Path(sys.argv[1]), sys.argv[2])
(folder.path / "scene.pov").write_text("sphere{}")
os.kill(os.getpid(), 9)
"""


def die_at(wanted, parent):
    """Makes, fills and removes a folder; kills this process before the line of that number."""
    lines = itertools.count()

    def trace(frame, event, argument):
        if event == "line" and next(lines) == wanted:
            os.kill(os.getpid(), signal.SIGKILL)
        return trace

    try:
        sys.settrace(trace)
        folder = LockedFolder(parent, "a.scene")
        (folder.path / "scene.pov").write_text("sphere{}")
        (folder.path / "objects").mkdir()
        (folder.path / "objects" / "ball.inc").write_text("sphere{}")
        folder.remove()
    except BaseException:
        os._exit(1)
    os._exit(0)


class Folders(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.parent = Path(folder.name)

    def die(self, name="a.scene"):
        environment = {**os.environ, "PYTHONPATH": str(Path(addon_path.__file__).parent)}
        subprocess.run([sys.executable, "-c", DYING, str(self.parent), name], env=environment)

    def names(self):
        return sorted(path.name for path in self.parent.iterdir())

    def test_nothing_is_abandoned_where_nothing_is(self):
        locked_folder.settle(self.parent, "a.scene")
        locked_folder.settle(self.parent / "nowhere", "a.scene")
        self.assertEqual(self.names(), [])

    def test_a_living_owner_keeps_its_folder(self):
        folder = LockedFolder(self.parent, "a.scene")
        locked_folder.settle(self.parent, "a.scene")
        self.assertTrue(folder.path.is_dir())
        folder.remove()
        self.assertEqual(self.names(), [])

    def test_a_kept_folder_is_the_users(self):
        folder = LockedFolder(self.parent, "a.scene")
        (folder.path / "scene.pov").write_text("sphere{}")
        folder.keep()
        locked_folder.settle(self.parent, "a.scene")
        self.assertEqual(os.listdir(folder.path), ["scene.pov"])

    def test_a_killed_owners_folder_is_removed_or_kept_as_asked(self):
        self.die()
        self.die()
        self.die("b.scene")
        kept = [name for name in self.names() if name.startswith("a.scene")]
        locked_folder.settle(self.parent, "a.scene", keep=True)
        locked_folder.settle(self.parent, "a.scene")
        locked_folder.settle(self.parent, "b.scene")
        self.assertEqual(self.names(), kept)
        self.assertEqual([os.listdir(self.parent / name) for name in kept], [["scene.pov"]] * 2)

    def test_a_folder_whose_owner_was_killed_between_any_two_lines_is_removed(self):
        ends, left = 0, 0
        for line in range(5000):
            child = os.fork()
            if child == 0:
                die_at(line, self.parent)
            _, status = os.waitpid(child, 0)
            left += self.names() != []
            locked_folder.settle(self.parent, "a.scene")
            self.assertEqual(self.names(), [], f"killed at line {line}")
            ends += os.WIFEXITED(status)
            if ends:
                break
        self.assertEqual((ends, os.WEXITSTATUS(status)), (1, 0))
        self.assertGreater(left, 10)

    def test_a_new_folder_taken_for_a_dead_ones_is_made_again(self):
        make, made = tempfile.mkdtemp, []

        def made_and_settled(**options):
            made.append(make(**options))
            if len(made) < 3:
                locked_folder.settle(self.parent, "a.scene")
            return made[-1]

        with mock.patch.object(tempfile, "mkdtemp", made_and_settled):
            folder = LockedFolder(self.parent, "a.scene")
        self.assertEqual(len(made), 3)
        locked_folder.settle(self.parent, "a.scene")
        self.assertEqual(self.names(), [folder.path.name])
        folder.remove()

    def test_two_cannot_keep_their_scene_in_one_folder(self):
        kept = self.parent / "a.scene"
        with SceneFolder(kept, "ALWAYS") as first:
            (first.path / "scene.pov").write_text("sphere{}")
            with self.assertRaisesRegex(OSError, "another Blender"):
                SceneFolder(kept, "ALWAYS").__enter__()
        self.assertEqual(os.listdir(kept), ["scene.pov"])
        with SceneFolder(kept, "ALWAYS") as second:
            self.assertEqual(second.path, kept)

    def test_a_killed_owner_of_the_users_folder_is_not_in_the_way(self):
        (self.parent / "in_use").write_text("")
        locked_folder.Hold(self.parent).release()
        self.assertEqual(self.names(), [])

    def test_a_folder_kept_while_it_is_taken_for_a_dead_ones_stays(self):
        folder = LockedFolder(self.parent, "a.scene")
        (folder.path / "scene.pov").write_text("sphere{}")
        lock = fcntl.flock

        def kept_before(file, how):
            folder.keep()
            lock(file, how)

        with mock.patch.object(fcntl, "flock", kept_before):
            locked_folder.settle(self.parent, "a.scene")
        self.assertEqual(os.listdir(folder.path), ["scene.pov"])

    def test_what_vanishes_meanwhile_does_not_save_the_rest(self):
        self.die()
        (folder,) = self.parent.iterdir()
        for name in "abcd":
            (folder / name).write_text("")
        unlink = os.unlink

        def vanished(path, **options):
            unlink(path, **options)
            if Path(path).name != locked_folder.MARK:
                raise FileNotFoundError(path)

        with mock.patch.object(os, "unlink", vanished):
            locked_folder.settle(self.parent, "a.scene")
        self.assertEqual(self.names(), [])

    def test_folders_of_others_are_never_touched(self):
        names = ("mine", "textures", "the_link", "mystuff_")
        for name in ("a.scene", "b", *(f"a.scene-{name}" for name in names)):
            (self.parent / name).mkdir()
        outside = self.parent / "b" / "precious"
        outside.write_text("x")
        (self.parent / "a.scene-mystuff_" / "precious").write_text("x")
        (self.parent / "a.scene-the_link" / locked_folder.MARK).symlink_to(outside)
        (self.parent / "b" / locked_folder.MARK).write_text("")
        (self.parent / "a.scene-to_there").symlink_to(self.parent / "b")
        before = self.names()
        locked_folder.settle(self.parent, "a.scene")
        self.assertEqual(self.names(), before)
        self.assertEqual(outside.read_text(), "x")

    def test_folders_of_killed_runs_of_other_files_are_removed(self):
        for name in ("a.scene", "other.scene", "unsaved.scene", "mine", "a.scenery"):
            self.die(name)
        (self.parent / "b").mkdir()
        (self.parent / "b" / locked_folder.MARK).write_text("")
        (self.parent / "b.scene-to_there").symlink_to(self.parent / "b")
        (self.parent / "b.scene-Textures").mkdir()
        (self.parent / "b.scene-Textures" / locked_folder.MARK).write_text("")
        living = LockedFolder(self.parent, "living.scene")
        own = {name for name in self.names() if name.split(".")[0] in ("a", "other", "unsaved")}
        removed = {name for name in own if not name.startswith("a.scenery")}
        left = set(self.names()) - removed
        with mock.patch.dict(os.environ, LODESTONE_CACHE=str(self.parent)):
            with SceneFolder(self.parent / "sub" / "new.scene", "ALWAYS"):
                self.assertEqual(len(removed), 3)
                self.assertEqual(set(self.names()), left | {"sub"})
        living.remove()

    def test_any_name_of_a_file_makes_a_folder(self):
        for name in ("x" * 255, "名" * 85, "a b'\"\n", "-rf"):
            folder = LockedFolder(self.parent, name)
            self.assertTrue(folder.path.is_dir())
            locked_folder.settle(self.parent, name)
            self.assertTrue(folder.path.is_dir())
            folder.remove()
        self.assertEqual(self.names(), [])


if __name__ == "__main__":
    unittest.main()
