# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the scene's files between pictures: used again where they last, never more than needed."""

import tempfile
import unittest
from pathlib import Path

import addon_path  # noqa: F401
from lodestone.core.background_calls import Stopped
from lodestone.core.picture.picture_maker import remove_others, used_files
from lodestone.core.picture.render_folder import RenderFolder

SHAPE, OTHER = "0123456789abcdef", "fedcba9876543210"


def write_scene(folder, shape, pictures=()):
    """A scene of one representation that shows pictures, as exports write them."""
    for name in ("r", "i"):
        (folder / name).mkdir(exist_ok=True)
    for name in pictures:
        (folder / "i" / f"{name}.png").write_text("picture")
    listed = "".join(f"// i/{name}.png\n" for name in pictures)
    (folder / "r" / f"{shape}.inc").write_text(listed + "#declare X = 1;\n")
    (folder / "scene.pov").write_text(f'#include "r/{shape}.inc"\n')


def files(folder):
    return sorted(str(path.relative_to(folder)) for path in folder.glob("[ri]/*"))


class UsedFiles(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_representations_and_their_pictures_are_used(self):
        write_scene(self.folder, OTHER, (OTHER,))
        write_scene(self.folder, SHAPE, (SHAPE,))
        used = used_files(self.folder)
        self.assertEqual(used, {f"r/{SHAPE}.inc", f"i/{SHAPE}.png"})
        remove_others(self.folder, used)
        self.assertEqual(files(self.folder), [f"i/{SHAPE}.png", f"r/{SHAPE}.inc"])

    def test_what_is_kept_beside_representations_is_used(self):
        write_scene(self.folder, SHAPE)
        for name in (SHAPE, OTHER):
            (self.folder / "r" / f"{name}.cut").write_text("1 40\n")
        with open(self.folder / "scene.pov", "a") as scene:
            scene.write(f"// r/{OTHER}.cut\n")
        remove_others(self.folder, used_files(self.folder))
        self.assertEqual(files(self.folder), sorted([f"r/{OTHER}.cut", f"r/{SHAPE}.inc"]))

    def test_a_picture_of_the_sky_is_used(self):
        write_scene(self.folder, SHAPE)
        (self.folder / "i" / f"{OTHER}.png").write_text("sky")
        with open(self.folder / "scene.pov", "a") as scene:
            scene.write(f'sky_sphere{{pigment{{image_map{{png "i/{OTHER}.png"}}}}}}\n')
        remove_others(self.folder, used_files(self.folder))
        self.assertEqual(files(self.folder), [f"i/{OTHER}.png", f"r/{SHAPE}.inc"])

    def test_a_representation_that_is_gone_is_no_failure(self):
        (self.folder / "scene.pov").write_text(f'#include "r/{SHAPE}.inc"\n')
        self.assertEqual(used_files(self.folder), {f"r/{SHAPE}.inc"})


class Lasting(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.parent = Path(folder.name)
        self.kept = self.parent / "file.scene"

    def held(self, lasting):
        held = RenderFolder(lasting)
        self.addCleanup(held.close)
        return held

    def render(self, held, shape=SHAPE, keep="FAILED", error=None):
        """One render of one frame; the folder it had."""
        held.end_render()
        try:
            with held.use(self.kept, keep, 1) as folder:
                write_scene(folder.path, shape)
                if error is not None:
                    raise error
        except type(error) if error is not None else ():
            pass
        held.end_render()
        return folder.path

    def test_without_a_window_nothing_stays_after_a_render(self):
        held = self.held(lasting=False)
        self.assertFalse(self.render(held).exists())
        self.assertFalse(self.render(held, error=Stopped()).exists())

    def test_the_next_render_uses_the_files_again_until_the_end(self):
        held = self.held(lasting=True)
        first = self.render(held)
        self.assertTrue(first.is_dir())
        self.assertEqual(self.render(held), first)
        self.assertEqual(self.render(held, error=Stopped()), first)
        self.assertEqual(self.render(held), first)
        held.close()
        self.assertEqual(list(self.parent.iterdir()), [])

    def test_what_two_renders_did_not_use_is_removed(self):
        held = self.held(lasting=True)
        folder = self.render(held, OTHER)
        self.render(held)
        self.assertEqual(len(files(folder)), 2)
        self.render(held)
        self.assertEqual(files(folder), [f"r/{SHAPE}.inc"])

    def test_a_failed_scene_is_the_users_and_not_used_again(self):
        held = self.held(lasting=True)
        failed = self.render(held, error=ValueError())
        self.assertTrue((failed / "scene.pov").is_file())
        self.assertNotEqual(self.render(held), failed)
        held.close()
        self.assertEqual(list(self.parent.iterdir()), [failed])

    def test_a_folder_that_somebody_removed_is_made_anew(self):
        held = self.held(lasting=True)
        first = self.render(held)
        for path in sorted(first.rglob("*"), reverse=True):
            path.rmdir() if path.is_dir() else path.unlink()
        first.rmdir()
        self.assertTrue((self.render(held) / "scene.pov").is_file())

    def test_the_users_own_folder_is_free_between_renders(self):
        held, other = self.held(lasting=True), self.held(lasting=True)
        self.assertEqual(self.render(held, keep="ALWAYS"), self.kept)
        self.assertEqual(self.render(other, keep="ALWAYS"), self.kept)


if __name__ == "__main__":
    unittest.main()
