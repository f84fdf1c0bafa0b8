# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards what Update Levels costs a file of many objects: its size, what exporters see."""

import importlib.util
import tempfile
import unittest
from pathlib import Path

import bpy

import blender_scenes as scenes

HOUSES = 90
PARTS = 10  # in a house, half of them with a mesh of their own, half linked


def town():
    """1,000 objects in collections four deep: houses of parts with linked and unique meshes, and
    empties that instance them; every twentieth house is marked Environment. Of three kinds, each
    in one place: equal contents are built once, and the test is about the file."""
    scene = scenes.fresh()
    shared = [scenes.cube_mesh(f"Shared {i}", 0.2 + 0.1 * i) for i in range(PARTS // 2)]
    paint = scenes.material("Paint")
    for data in shared:
        data.materials.append(paint)
    districts = []
    for i in range(3):
        district = scenes.collection(f"District {i}", scene.collection)
        districts += [scenes.collection(f"Street {i}.{k}", district) for k in range(3)]
    for i in range(HOUSES):
        street = districts[i % len(districts)]
        house = scenes.collection(f"House {i}", street)
        rooms = [scenes.collection(f"Room {i}.{k}", house) for k in range(2)]
        for k in range(PARTS):
            place = (4 * (i % 3) + k % 3, k % 5, 0.5 * k)
            name, room = f"Part {i}.{k}", rooms[k % 2]
            if k < len(shared):
                scenes.cube(name, place, data=shared[k], collection=room)
            else:
                scenes.cube(name, place, 0.3 + 0.1 * (i % 3 + k), collection=room)
        scenes.instance(f"Copy {i}", house, (0, 20, 4 * (i // 9)), parent=street)
        if i % 20 == 0:
            house.lodestone.role = "ENVIRONMENT"
    for i in range(9):
        scenes.cube(f"Ground {i}", (40 * i, 0, -20), 40).lodestone.role = "ENVIRONMENT"
    return scene


class UntouchedFile(unittest.TestCase):
    def test_a_thousand_objects_grow_by_two_percent_at_most_and_export_the_same_bytes(self):
        with_exporter = importlib.util.find_spec("numpy") is not None
        if with_exporter:
            bpy.ops.preferences.addon_enable(module="io_scene_gltf2")
        with tempfile.TemporaryDirectory() as folder:
            blend = Path(folder) / "town.blend"

            def saved():
                bpy.ops.wm.save_as_mainfile(filepath=str(blend), compress=False)
                return blend.stat().st_size

            def exported(name):
                path = Path(folder) / name
                bpy.ops.export_scene.gltf(filepath=str(path))
                return path.read_bytes()

            town()
            self.assertGreaterEqual(len(bpy.data.objects), 1000)
            # Exported before the size is taken: the exporter itself leaves data in meshes.
            before, size = exported("before.glb") if with_exporter else b"", saved()
            held = sum("lodestone" in item.keys() for item in bpy.data.objects)
            self.assertEqual(bpy.ops.lodestone.update_levels(), {"FINISHED"})
            growth = saved() / size - 1
            print(f"{len(bpy.data.objects)} objects, {size:,} bytes: {100 * growth:+.3f} %")
            self.assertLessEqual(growth, 0.02)
            self.assertEqual(sum("lodestone" in item.keys() for item in bpy.data.objects), held)
            if not with_exporter:
                self.skipTest("the size holds; Blender's glTF exporter needs numpy")
            self.assertGreater(len(before), 100000)
            self.assertTrue(exported("after.glb") == before, "Update Levels changes the export")


if __name__ == "__main__":
    unittest.main()
