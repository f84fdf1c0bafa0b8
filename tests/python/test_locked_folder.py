# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards temporary folders: a living owner's is left alone, a dead one's is found."""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import addon_path
from lodestone.core import locked_folder
from lodestone.core.locked_folder import LockedFolder
from lodestone.core.picture import SceneFolder

DYING = """
import os, sys
from pathlib import Path
import addon_path
from lodestone.core.locked_folder import LockedFolder
folder = LockedFolder(Path(sys.argv[1]), sys.argv[2])
(folder.path / "scene.pov").write_text("sphere{}")
os.kill(os.getpid(), 9)
"""


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
        folder.keep()
        locked_folder.settle(self.parent, "a.scene")
        self.assertEqual(list(folder.path.iterdir()), [])

    def test_a_killed_owners_folder_is_removed_or_kept_as_asked(self):
        self.die()
        self.die()
        self.die("b.scene")
        first, second = locked_folder.abandoned(self.parent, "a.scene")
        locked_folder.settle(self.parent, "a.scene", keep=True)
        self.assertEqual(os.listdir(first), ["scene.pov"])
        self.assertEqual(list(locked_folder.abandoned(self.parent, "a.scene")), [])
        locked_folder.settle(self.parent, "b.scene")
        self.assertEqual(self.names(), sorted([first.name, second.name]))

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

    def test_folders_of_others_are_never_touched(self):
        for name in ("a.scene-mine", "a.scene", "a.scene-link", "b"):
            (self.parent / name).mkdir()
        outside = self.parent / "b" / "precious"
        outside.write_text("x")
        (self.parent / "a.scene-link" / locked_folder.MARK).symlink_to(outside)
        before = self.names()
        locked_folder.settle(self.parent, "a.scene")
        self.assertEqual(self.names(), before)

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
