# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards what viewports draw of levels, without Blender: choosing, batches, changes, views."""

import math
import tempfile
import time
import unittest
from array import array
from dataclasses import replace
from pathlib import Path
from unittest import mock

import addon_path  # noqa: F401 - makes the add-on importable
from lodestone.core.preview import preview_tree, preview_worker
from lodestone.core.preview.preview_tree import IDENTITY, Change, Names
from lodestone.core.preview.preview_worker import Made, Picture, Things, Wanted
from lodestone_native import Camera, Cut, MeshBuffers, Model, View

ROOT, GROUP, LEAF = "r" * 16, "c" * 16, "a" * 16
CAMERA = Camera("C", False, (0, -10, 0), (0, 1, 0), (1, 0, 0), (0, 0, 0.6), 0.1)
WANTED = Wanted(CAMERA, (640, 384), 0.0, things=Things())


def moved(x, y=0.0, z=0.0):
    return (1.0, 0.0, 0.0, x, 0.0, 1.0, 0.0, y, 0.0, 0.0, 1.0, z)


def tetra():
    corners = array("f", [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1])
    return MeshBuffers(corners, array("i", [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]))


def hill(size=24):
    """2 size^2 triangles of which levels can be made."""
    corners, faces = array("f"), array("i")
    for y in range(size + 1):
        for x in range(size + 1):
            corners.extend(
                (x / size, y / size, 0.2 * math.sin(7 * x / size) * math.cos(5 * y / size))
            )
    for y in range(size):
        for x in range(size):
            at = y * (size + 1) + x
            faces.extend((at, at + 1, at + size + 1, at + 1, at + size + 2, at + size + 1))
    return MeshBuffers(corners, faces)


def made(buffers=None):
    """A scene: collection "Pair" with objects "Left" at 0 and "Right" at 5, and "Alone" at 9."""
    model = Model()
    leaf = model.add_mesh(LEAF, "Tetra", buffers or tetra())
    pair = model.add_group(GROUP, "Pair")
    model.add_placement(pair, leaf, IDENTITY, "Left")
    model.add_placement(pair, leaf, moved(5), "Right")
    root = model.add_group(ROOT, "Scene")
    model.add_placement(root, pair, IDENTITY, "Pair")
    model.add_placement(root, leaf, moved(9), "Alone")
    model.set_root(root)
    return model, root


def tree_of(model, root, objects=("Left", "Right", "Alone")):
    return preview_tree.tree_of(model, root, set(objects).__contains__, {GROUP: "Pair"}.get)


def xs(model):
    """Where along x things are drawn."""
    with Cut(model, View(CAMERA, 640, 384, 0.0)) as cut:
        return sorted(choice.world[3] for choice in cut.choices())


class Trees(unittest.TestCase):
    def test_inverse_and_product_are_the_identity(self):
        turn = (0.0, -2.0, 0.0, 3.0, 2.0, 0.0, 0.0, -1.0, 0.0, 0.5, 4.0, 7.0)
        for product in (
            preview_tree.multiply(turn, preview_tree.inverse(turn)),
            preview_tree.multiply(preview_tree.inverse(turn), turn),
        ):
            self.assertTrue(preview_tree.same(product, IDENTITY), product)
        self.assertIsNone(preview_tree.inverse((1.0, 0.0, 0.0, 0.0) * 3))

    def test_objects_and_collections_are_found_where_they_stand(self):
        model, root = made()
        tree = tree_of(model, root)
        self.assertEqual(set(tree.objects), {"Left", "Right", "Alone"})
        self.assertEqual(tree.objects["Right"][0].world, moved(5))
        self.assertEqual(set(tree.collections), {GROUP})
        self.assertEqual((tree.lost, tree.inner), ([], {}))

    def test_what_no_object_is_left_of_is_lost(self):
        model, root = made()
        tree = tree_of(model, root, ("Left",))
        self.assertEqual([slot.world for slot in tree.lost], [moved(9), moved(5)])

    def test_members_of_what_an_object_instances_are_inner(self):
        model, root = made()
        empty = model.find_object(GROUP)
        model.add_placement(root, empty, moved(20), "Empty")
        outer = model.add_group("d" * 16, "Other")
        model.add_placement(outer, empty, moved(1), "Empty")
        model.set_root(outer)
        tree = preview_tree.tree_of(
            model, outer, {"Left", "Right", "Empty"}.__contains__, {GROUP: "Pair"}.get
        )
        self.assertEqual(set(tree.objects), {"Empty"})
        self.assertEqual(set(tree.inner), {"Left", "Right"})
        self.assertEqual(tree.collections[GROUP], tree.objects["Empty"])

    def test_moved_hidden_and_pinned_things_are_drawn_so_and_taken_back(self):
        model, root = made()
        tree = tree_of(model, root)
        left, right = tree.objects["Left"][0], tree.objects["Right"][0]
        preview_tree.apply(model, left, Change(world=moved(-3)))
        self.assertEqual(xs(model), [-3, 5, 9])
        preview_tree.apply(model, right, Change(hidden=True))
        self.assertEqual(xs(model), [-3, 9])
        preview_tree.take_back(model, left, Change())
        preview_tree.take_back(model, right, Change(coarsest=0, pinned=True))
        self.assertEqual(xs(model), [0, 5, 9])
        self.assertEqual(model.decided(model.find_object(GROUP))[1][1], 0)


class Workers(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def worker(self, objects=("Left", "Right", "Alone")):
        names = Names(frozenset(objects), {GROUP: "Pair"}, ROOT)
        found = preview_worker.Worker(self.folder, names)
        self.addCleanup(found.close)
        return found

    def store(self, buffers=None):
        model, _ = made(buffers)
        with model:
            model.build(str(self.folder))

    def answers(self, worker, viewport=1, wanted=WANTED):
        """(meshes by key, pictures) of what is asked for."""
        worker.ask(viewport, wanted)
        meshes, pictures, end = {}, [], time.monotonic() + 20
        while not (pictures and pictures[-1].final):
            item = worker.take()
            if isinstance(item, Made):
                self.assertNotIn(item.key, meshes)
                meshes[item.key] = item.mesh
            elif isinstance(item, Picture):
                pictures += [item] if item.viewport == viewport else []
            elif item is not None and item is not preview_worker.READY:
                self.fail(item)
            elif time.monotonic() > end:
                self.fail(worker.problem or "no picture")
            else:
                time.sleep(0.002)
        return meshes, pictures

    def test_without_a_store_nothing_is_drawn_and_nothing_fails(self):
        worker = self.worker()
        meshes, pictures = self.answers(worker)
        self.assertEqual((meshes, pictures[-1].keys, worker.tree), ({}, (), None))
        self.assertEqual(worker.problem, "")

    def test_a_broken_store_is_named(self):
        (self.folder / "tileset.json").write_text("{")
        worker = self.worker()
        self.answers(worker)
        self.assertIn("tileset.json", worker.problem)

    def test_a_store_of_another_scene_has_nothing(self):
        self.store()
        names = Names(frozenset(), {}, "f" * 16)
        worker = preview_worker.Worker(self.folder, names)
        self.addCleanup(worker.close)
        self.assertEqual(self.answers(worker)[1][-1].drawn, 0)

    def test_batches_hold_what_the_model_has_where_it_stands(self):
        self.store()
        meshes, pictures = self.answers(self.worker())
        picture = pictures[-1]
        self.assertEqual((picture.triangles, picture.drawn), (12, 3))
        self.assertLessEqual(set(picture.keys), set(meshes))  # the first picture is coarser
        meshes = {key: meshes[key] for key in picture.keys}
        self.assertEqual(sum(len(mesh.triangles) for mesh in meshes.values()), 3 * 12)
        points = {
            tuple(mesh.positions[i : i + 3])
            for mesh in meshes.values()
            for i in range(0, len(mesh.positions), 3)
        }
        self.assertEqual(
            {x for x, y, z in points if (y, z) == (0.0, 0.0)}, {0.0, 1.0, 5.0, 6.0, 9.0, 10.0}
        )
        low = [min(mesh.box[0] for mesh in meshes.values())]
        self.assertEqual(low, [0.0])

    def test_what_is_there_is_not_made_again_until_it_was_dropped(self):
        self.store()
        worker = self.worker()
        _, pictures = self.answers(worker)
        again, others = self.answers(worker, 2)
        self.assertEqual((again, others[-1].keys), ({}, pictures[-1].keys))
        worker.dropped(pictures[-1].keys)
        third, _ = self.answers(worker, 3)
        self.assertEqual(set(third), set(pictures[-1].keys))

    def test_the_next_picture_goes_along_and_is_as_one_made_anew(self):
        self.store(hill(48))
        worker = self.worker()
        self.answers(worker)
        seen = set()
        with mock.patch.object(Cut, "step", autospec=True, side_effect=Cut.step) as step:
            for away in (10, 40, 160, 11):
                camera = replace(CAMERA, position=(0, -away, 0))
                wanted = replace(WANTED, camera=camera, pixel_error=1.0)
                pictures = self.answers(worker, 1, wanted)[1]
                fresh = self.answers(self.worker(), 1, wanted)[1]
                self.assertEqual(pictures[-1].keys, fresh[-1].keys)
                self.assertEqual(pictures[-1].triangles, fresh[-1].triangles)
                seen.add(pictures[-1].triangles)
        self.assertGreaterEqual(step.call_count, 4)
        self.assertGreater(len(seen), 1)

    def test_a_budget_between_two_pictures_changes_neither(self):
        self.store(hill(48))
        worker = self.worker()
        wanted = replace(WANTED, pixel_error=0.5)
        first = self.answers(worker, 1, wanted)[1][-1]
        few = self.answers(worker, 1, replace(wanted, triangles=500))[1][-1]
        self.assertLess(few.triangles, first.triangles)
        self.assertEqual(self.answers(worker, 1, wanted)[1][-1].keys, first.keys)

    def test_a_moved_thing_is_elsewhere_and_back_again(self):
        self.store()
        worker = self.worker()
        self.answers(worker)
        slot = worker.tree.objects["Right"][0]
        there = Things({slot.key: Change(world=moved(-40))})
        meshes, _ = self.answers(worker, 1, replace(WANTED, state=1, things=there))
        self.assertEqual(min(mesh.box[0] for mesh in meshes.values()), -40.0)
        gone = Things({slot.key: Change(hidden=True)})
        _, pictures = self.answers(worker, 1, replace(WANTED, state=2, things=gone))
        self.assertEqual(pictures[-1].drawn, 2)
        meshes, pictures = self.answers(worker, 1, replace(WANTED, state=3))
        self.assertEqual((meshes, pictures[-1].drawn), ({}, 3))

    def test_a_forced_level_is_every_objects_and_no_groups(self):
        self.store(hill())
        worker = self.worker()
        coarse = replace(WANTED, pixel_error=200.0)
        before = self.answers(worker, 1, coarse)[1][-1]
        self.assertLess(before.triangles, 3 * 1152)
        slot = worker.tree.objects["Right"][0]
        pinned = Things({slot.key: Change(coarsest=0, pinned=True)})
        found = []
        for number, things in enumerate((Things(), pinned)):
            for lod in (0, 1, 2, 31):
                wanted = replace(coarse, force=lod, state=number, things=things)
                picture = self.answers(worker, 1, wanted)[1][-1]
                self.assertEqual(picture.drawn, 3)
                found.append(picture.triangles)
        self.assertEqual(found[:4], found[4:], "what is decided counts")
        self.assertEqual(found[0], 3 * 1152)
        self.assertEqual(sorted(set(found), reverse=True), found[:4])
        self.assertTrue(all(count % 3 == 0 for count in found))
        after = self.answers(worker, 1, coarse)[1][-1]
        self.assertEqual((after.keys, after.triangles), (before.keys, before.triangles))

    def test_a_forced_level_of_too_much_is_a_sentence(self):
        self.store(hill())
        worker = self.worker()
        self.answers(worker)
        with mock.patch.object(preview_worker, "MOST_TRIANGLES", 1000):
            worker.ask(1, replace(WANTED, force=0))
            item, end = None, time.monotonic() + 20
            while item is None and time.monotonic() < end:
                item = worker.take()
        self.assertIn("LOD 0 of everything is 3,456 triangles", item.text)
        self.assertIn("force a coarser one", item.text)

    def test_two_viewports_have_a_picture_each(self):
        self.store()
        worker = self.worker()
        worker.ask(1, WANTED)
        _, pictures = self.answers(worker, 2, replace(WANTED, mode="LEVEL"))
        _, others = self.answers(worker, 1)
        self.assertNotEqual(pictures[-1].keys, others[-1].keys)

    def test_false_colors_are_other_batches(self):
        self.store()
        worker = self.worker()
        plain, pictures = self.answers(worker)
        painted, _ = self.answers(worker, 1, replace(WANTED, mode="LEVEL"))
        self.assertEqual(set(plain) & set(painted), set())
        self.assertEqual(len(painted), len(pictures[-1].keys))

    def test_closing_does_not_wait_for_questions(self):
        self.store()
        worker = self.worker()
        for number in range(50):
            worker.ask(number, WANTED)
        start = time.monotonic()
        worker.close()
        self.assertLess(time.monotonic() - start, 5.0)

    def test_nonsense_is_answered_by_a_sentence(self):
        self.store()
        worker = self.worker()
        self.answers(worker)
        worker.ask(1, replace(WANTED, pixel_error=math.nan))
        end = time.monotonic() + 20
        item = None
        while item is None and time.monotonic() < end:
            item = worker.take()
        self.assertIn("Pixel Error", item.text)
        self.assertEqual(self.answers(worker)[1][-1].drawn, 3)


if __name__ == "__main__":
    unittest.main()
