# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the designer's file: Update Levels writes the ids that are needed and nothing else, Clear
takes them back."""

import os
import tempfile
import unittest
from pathlib import Path

import bpy

import blender_scenes as scenes


def street():
    scene = scenes.fresh()
    house = scenes.collection("House")
    wall = scenes.cube("Wall", collection=house)
    wall.data.materials.append(scenes.material("Plaster"))
    wall.modifiers.new("Subdivision", "SUBSURF").render_levels = 4
    scenes.cube("Chair", (1, 0, 0), 0.3, collection=scenes.collection("Furniture", house))
    row = scenes.collection("Row", scene.collection)
    for i in range(3):
        scenes.instance(f"House.{i}", house, (4 * i, 0, 0), parent=row)
    scenes.cube("Ground", (0, 0, -1), 9)
    return scene


def described(datablock):
    """Everything Blender saves of it but our own settings: {property path: value}."""
    found = {}

    def tell(item, depth, path):
        for prop in item.bl_rna.properties:
            if prop.identifier in {"rna_type", "original", "lodestone", "is_evaluated"}:
                continue
            try:
                value = getattr(item, prop.identifier)
            except (AttributeError, RuntimeError):
                continue
            name = f"{path}.{prop.identifier}"
            if prop.type == "COLLECTION":
                found[name] = len(value)
                for number, child in enumerate(value if depth < 2 else ()):
                    tell(child, depth + 1, f"{name}[{number}]")
            elif prop.type == "POINTER":
                found[name] = getattr(value, "name", "") if value else None
            else:
                found[name] = repr(value[:] if hasattr(value, "__getitem__") else value)

    tell(datablock, 0, f"{type(datablock).__name__} {datablock.name}")
    return found


def all_described():
    found = {}
    for kind in ("scenes", "collections", "objects", "meshes", "materials", "cameras", "lights"):
        for item in getattr(bpy.data, kind):
            found.update(described(item))
    return found


def ours():
    """Names of the datablocks that hold anything of ours."""
    blocks = (*bpy.data.scenes, *bpy.data.collections, *bpy.data.objects)
    return [item.name for item in blocks if "lodestone" in item.keys()]


class UpdateLevels(unittest.TestCase):
    def setUp(self):
        self.scene = street()
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.blend = str(self.folder / "street.blend")
        bpy.ops.wm.save_as_mainfile(filepath=self.blend)

    def uids(self):
        """{name: stored id} of what holds anything of ours."""
        things = (*bpy.data.collections, *bpy.data.objects)
        return {item.name: item.lodestone.uid for item in things if "lodestone" in item.keys()}

    def levels(self, item):
        """What the panel shows of an object or a collection."""
        from lodestone.bridge import object_decisions
        from lodestone.core.session.addon_session import addon_session
        from lodestone.core.store import store_path

        store = addon_session().stores.open(store_path.store_folder(bpy.data.filepath))
        self.assertEqual(store.problem, "")
        return next(filter(None, map(store.levels, object_decisions.levels_uids(item))), ())

    def test_fills_the_store_beside_the_file_and_leaves_the_file_untouched(self):
        self.assertEqual(bpy.ops.lodestone.update_levels(), {"FINISHED"})
        self.assertTrue((self.folder / "lodestone" / "street" / "tileset.json").is_file())
        self.assertEqual(self.uids(), {})

    def test_what_holds_a_decision_gets_an_id_and_nothing_else_does(self):
        for item in (bpy.data.objects["Ground"], bpy.data.collections["House"]):
            item.lodestone.role = "ENVIRONMENT"
        bpy.ops.lodestone.update_levels()
        uids = self.uids()
        self.assertEqual(sorted(uids), ["Ground", "House"])
        self.assertTrue(all(len(uid) == 16 for uid in uids.values()), uids)
        self.assertEqual(len(set(uids.values())), 2)

    def test_a_second_time_builds_nothing(self):
        from lodestone.operators.update_levels import update_levels

        first = update_levels(bpy.context, "SCENE")
        second = update_levels(bpy.context, "SCENE")
        self.assertGreater(first.built, 0)
        self.assertEqual(second.built, 0)

    def test_an_empty_file_has_no_object_to_build(self):
        from lodestone.operators.update_levels import summary, update_levels

        for item in list(bpy.data.objects):
            bpy.data.objects.remove(item)
        report = update_levels(bpy.context, "SCENE")
        self.assertEqual((report.objects, report.built), (0, 0))
        self.assertEqual(summary(report), "There is nothing here to build levels of")

    def test_writing_ids_makes_nothing_stale(self):
        from lodestone.core.native import lodestone_native as native
        from lodestone.engines import extract_engine
        from lodestone.operators.update_levels import update_levels

        store = str(self.folder / "lodestone" / "street")
        extraction = extract_engine.extract_now(self.scene, extract_engine.Request())
        with extraction.model as model:  # as F12 and batch build: no ids in the file
            Path(store).mkdir(parents=True)
            self.assertGreater(model.build(store, native.BuildOptions()).built, 0)
        self.assertEqual(update_levels(bpy.context, "SCENE").built, 0)

    def test_after_a_rename_nothing_is_built_and_the_panel_finds_the_levels(self):
        from lodestone.operators.update_levels import update_levels

        things = {**bpy.data.objects, **bpy.data.collections}
        kept = bpy.data.objects["Chair"]
        kept.lodestone.role = "ENVIRONMENT"
        update_levels(bpy.context, "SCENE")
        before = {name: self.levels(item) for name, item in things.items()}
        self.assertGreater(len(before["Wall"]), 1)
        self.assertGreater(len(before["House"]), 1)
        for kind in ("objects", "collections", "meshes", "materials"):
            for item in getattr(bpy.data, kind):
                item.name = item.name + " renamed"
        self.assertEqual(update_levels(bpy.context, "SCENE").built, 0)
        self.assertEqual({name: self.levels(item) for name, item in things.items()}, before)
        self.assertEqual(list(self.uids()), [kept.name])

    def test_two_objects_that_swap_names_swap_no_levels(self):
        from lodestone.operators.update_levels import update_levels

        wall, chair = bpy.data.objects["Wall"], bpy.data.objects["Chair"]
        update_levels(bpy.context, "SCENE")
        before = self.levels(wall), self.levels(chair)
        self.assertNotEqual(*before)
        wall.name, wall.data.name = "away", "away"
        chair.name, chair.data.name = "Wall", "Wall"
        wall.name, wall.data.name = "Chair", "Chair"
        self.assertEqual(update_levels(bpy.context, "SCENE").built, 0)
        self.assertEqual((self.levels(wall), self.levels(chair)), before)

    def test_a_scope_builds_its_own_and_keeps_the_others_levels(self):
        from lodestone.operators.update_levels import NothingThere, update_levels

        for name in ("Ground", "Wall"):
            bpy.data.objects[name].lodestone.role = "ENVIRONMENT"
        house = bpy.context.view_layer.layer_collection.children["Row"]
        bpy.context.view_layer.active_layer_collection = house
        built = update_levels(bpy.context, "COLLECTION").built
        uids = self.uids()
        self.assertEqual((uids["Ground"], len(uids["Wall"])), ("", 16))
        for item in bpy.context.selected_objects:
            item.select_set(False)
        with self.assertRaises(NothingThere):
            update_levels(bpy.context, "SELECTED")
        bpy.data.objects["Ground"].select_set(True)
        self.assertEqual(update_levels(bpy.context, "SELECTED").built, 1)
        everything = update_levels(bpy.context, "SCENE")
        # Furniture is always opened: it is one chair.
        self.assertEqual(everything.built, everything.objects - built - 1 - 1)

    def test_a_copy_of_a_decided_object_gets_an_id_of_its_own(self):
        wall = bpy.data.objects["Wall"]
        wall.lodestone.role = "ENVIRONMENT"
        bpy.ops.lodestone.update_levels()
        copied = scenes.link(wall.copy())
        self.assertEqual(copied.lodestone.uid, wall.lodestone.uid)
        before = wall.lodestone.uid
        bpy.ops.lodestone.update_levels()
        self.assertEqual(wall.lodestone.uid, before)
        self.assertEqual(len(copied.lodestone.uid), 16)
        self.assertNotEqual(copied.lodestone.uid, before)

    def test_a_copy_without_a_decision_loses_the_id_it_was_copied_with(self):
        wall = bpy.data.objects["Wall"]
        wall.lodestone.uid = "0123456789abcdef"  # as an older file has them everywhere
        copied = scenes.link(wall.copy())
        bpy.ops.lodestone.update_levels()
        self.assertEqual(self.uids(), {"Wall": "0123456789abcdef"})
        self.assertNotIn("lodestone", copied.keys())

    def test_what_takes_the_name_of_a_renamed_thing_gets_an_id_of_its_own(self):
        ground = bpy.data.objects["Ground"]
        ground.lodestone.role = "ENVIRONMENT"
        bpy.ops.lodestone.update_levels()
        ground.name = "Meadow"
        scenes.cube("Ground", (0, 0, 3), 2)
        bpy.ops.lodestone.update_levels()
        uids = self.uids()
        self.assertEqual(sorted(uids), ["Ground", "Meadow"])
        self.assertEqual(len(set(uids.values())), 2)

    def test_the_users_datablocks_are_equal_before_and_after_clear(self):
        from lodestone.core import stable_ids

        before, held = all_described(), ours()
        for item in (*bpy.data.collections, *bpy.data.objects):  # also ids nobody needs go
            item.lodestone.uid = stable_ids.stable_id(item.name)
        bpy.ops.lodestone.update_levels()
        self.assertEqual(all_described(), before)
        bpy.ops.lodestone.clear_levels()
        self.assertEqual(all_described(), before)
        self.assertEqual((held, ours()), ([], []))
        self.assertFalse((self.folder / "lodestone" / "street").exists())

    def test_clear_keeps_decisions_until_they_are_asked_for(self):
        ground = bpy.data.objects["Ground"]
        ground.lodestone.role = "ENVIRONMENT"
        bpy.ops.lodestone.update_levels()
        bpy.ops.lodestone.clear_levels()
        self.assertEqual((ground.lodestone.role, ground.lodestone.uid), ("ENVIRONMENT", ""))
        bpy.ops.lodestone.update_levels()
        bpy.ops.lodestone.clear_levels(decisions=True)
        self.assertNotIn("lodestone", ground.keys())
        self.assertEqual(ground.lodestone.role, "AUTOMATIC")

    def test_clear_never_removes_a_folder_that_is_no_store(self):
        mine = self.folder / "lodestone" / "street"
        mine.mkdir(parents=True)
        (mine / "notes.txt").write_text("mine")
        bpy.ops.lodestone.clear_levels()
        self.assertEqual((mine / "notes.txt").read_text(), "mine")

    def test_a_failed_update_leaves_the_file_as_it_was(self):
        (self.folder / "lodestone").mkdir()
        (self.folder / "lodestone" / "street").write_text("in the way")
        cache = os.environ.get("LODESTONE_CACHE", "")
        self.addCleanup(os.environ.__setitem__, "LODESTONE_CACHE", cache)
        os.environ["LODESTONE_CACHE"] = self.blend  # no folder can be made in a file
        bpy.data.collections["Row"].lodestone.role = "ENVIRONMENT"
        bpy.data.objects["Wall"].lodestone.uid = "no id"
        before = all_described()
        with self.assertRaises(RuntimeError):
            bpy.ops.lodestone.update_levels()
        self.assertEqual(all_described(), before)
        self.assertEqual(self.uids(), {"Row": "", "Wall": "no id"})

    def test_settings_and_ids_survive_saving_and_loading(self):
        self.scene.lodestone.pixel_error_render = 4.0
        self.scene.lodestone.antialias = "OFF"
        bpy.data.collections["Row"].lodestone.role = "ENVIRONMENT"
        bpy.ops.lodestone.update_levels()
        uids = self.uids()
        bpy.ops.wm.save_mainfile()
        bpy.ops.wm.open_mainfile(filepath=self.blend)
        settings = bpy.context.scene.lodestone
        self.assertEqual((settings.pixel_error_render, settings.antialias), (4.0, "OFF"))
        self.assertEqual(bpy.data.collections["Row"].lodestone.role, "ENVIRONMENT")
        self.assertEqual(self.uids(), uids)

    def test_panels_find_the_levels(self):
        bpy.ops.lodestone.update_levels()
        for item in (bpy.data.objects["Wall"], bpy.data.collections["House"]):
            levels = self.levels(item)
            self.assertEqual(levels[0].error, 0.0)
            self.assertEqual(sorted(lv.error for lv in levels), [lv.error for lv in levels])
            self.assertGreater(len(levels), 1, item.name)


if __name__ == "__main__":
    unittest.main()
