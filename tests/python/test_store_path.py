# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards where levels are looked for: a store that moves by itself would be built again."""

import tempfile
import unittest
from pathlib import Path

import addon_path  # noqa: F401
from lodestone.core.store import store_path


class StoreFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.environment = {"LODESTONE_CACHE": str(self.folder / "cache")}

    def test_of_an_unsaved_file_is_in_the_cache(self):
        found = store_path.store_folder("", environment=self.environment)
        self.assertEqual(found, self.folder / "cache" / "unsaved")

    def test_lies_beside_the_file(self):
        blend = self.folder / "village.blend"
        found = store_path.store_folder(str(blend), environment=self.environment)
        self.assertEqual(found, self.folder / "lodestone" / "village")

    def test_an_override_wins(self):
        found = store_path.store_folder(str(self.folder / "a.blend"), "/elsewhere")
        self.assertEqual(found, Path("/elsewhere"))

    def test_where_nothing_can_be_written_it_is_in_the_cache_by_path(self):
        (self.folder / "file").write_text("no folder")
        a, b = (
            store_path.store_folder(
                str(self.folder / "file" / name / "a.blend"), environment=self.environment
            )
            for name in ("one", "two")
        )
        self.assertEqual(a.parent, self.folder / "cache")
        self.assertTrue(a.name.startswith("a-"))
        self.assertNotEqual(a, b)

    def test_a_file_in_the_place_of_the_folder_is_not_written_over(self):
        (self.folder / "lodestone").write_text("mine")
        blend = str(self.folder / "village.blend")
        found = store_path.store_folder(blend, environment=self.environment)
        self.assertEqual(found.parent, self.folder / "cache")

    def test_cache_follows_the_environment(self):
        self.assertEqual(store_path.cache_folder({"XDG_CACHE_HOME": "/c"}), Path("/c/lodestone"))
        self.assertEqual(store_path.cache_folder({}), Path.home() / ".cache" / "lodestone")

    def test_kept_scene_files_are_never_inside_the_store(self):
        store = self.folder / "lodestone" / "village"
        self.assertEqual(store_path.scene_folder(store).parent, store.parent)


if __name__ == "__main__":
    unittest.main()
