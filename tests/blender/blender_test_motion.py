# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards animations: what moves is grouped apart, and what deforms is drawn with levels that follow
it, the same ones in every frame, or as it is."""

import json
import re
import tempfile
import unittest
from pathlib import Path

import bpy

import blender_scenes as scenes


def keyed(item, *places):
    for frame, place in enumerate(places, 1):
        item.location = place
        item.keyframe_insert("location", frame=10 * frame)
    return item


def ball(name, collection=None, location=(0, 0, 0)):
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=4)
    made = bpy.context.object
    data = made.data
    bpy.data.objects.remove(made)
    item = bpy.data.objects.new(name, data)
    item.location = location
    return scenes.link(item, collection)


def nodes(item, with_time):
    tree = bpy.data.node_groups.new("Nodes", "GeometryNodeTree")
    tree.inputs.new("NodeSocketGeometry", "Geometry")
    tree.outputs.new("NodeSocketGeometry", "Geometry")
    given, shown = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    moved = tree.nodes.new("GeometryNodeTransform")
    tree.links.new(given.outputs[0], moved.inputs[0])
    tree.links.new(moved.outputs[0], shown.inputs[0])
    if with_time:
        time = tree.nodes.new("GeometryNodeInputSceneTime")
        tree.links.new(time.outputs["Seconds"], moved.inputs["Translation"])
    item.modifiers.new("Nodes", "NODES").node_group = tree


def armature(item, animated):
    rig = scenes.link(bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig")))
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    rig.data.edit_bones.new("Bone").tail = (0, 0, 1)
    bpy.ops.object.mode_set(mode="OBJECT")
    group = item.vertex_groups.new(name="Bone")
    group.add(range(len(item.data.vertices)), 1.0, "REPLACE")
    item.modifiers.new("Armature", "ARMATURE").object = rig
    if animated:
        bone = rig.pose.bones["Bone"]
        for frame in (1, 20):
            bone.location.x = frame
            bone.keyframe_insert("location", frame=frame)


class Found(unittest.TestCase):
    def setUp(self):
        scenes.fresh()

    def motion(self):
        from lodestone.bridge.motion.motion_sampling import Motion

        bpy.context.view_layer.update()
        return Motion()

    def test_what_nothing_animates_rests(self):
        item = ball("Ball")
        item.modifiers.new("Subdivision", "SUBSURF")
        nodes(item, with_time=False)
        armature(item, animated=False)
        item.constraints.new("COPY_LOCATION").target = scenes.cube("Other")
        motion = self.motion()
        self.assertFalse(motion.moves(item))
        self.assertFalse(motion.deforms(item))

    def test_keys_drivers_parents_constraints_and_physics_move(self):
        lead = keyed(ball("Lead"), (0, 0, 0), (5, 0, 0))
        child = ball("Child")
        child.parent = lead
        follower = ball("Follower")
        follower.constraints.new("COPY_LOCATION").target = child
        driven = ball("Driven")
        driven.driver_add("location", 0)
        motion = self.motion()
        for item in (lead, child, follower, driven):
            self.assertTrue(motion.moves(item), item.name)
            self.assertFalse(motion.deforms(item), item.name)

    def test_a_ring_of_constraints_ends(self):
        a, b = ball("A"), ball("B")
        a.constraints.new("COPY_LOCATION").target = b
        b.constraints.new("COPY_LOCATION").target = a
        self.assertFalse(self.motion().moves(a))

    def test_rigs_waves_shape_keys_time_nodes_and_hooks_deform(self):
        skinned, waving, keys, growing, hooked = (
            ball(name) for name in ("Skinned", "Waving", "Keys", "Growing", "Hooked")
        )
        armature(skinned, animated=True)
        waving.modifiers.new("Wave", "WAVE")
        keys.shape_key_add(name="Basis")
        keys.shape_key_add(name="Smile").keyframe_insert("value", frame=1)
        nodes(growing, with_time=True)
        hooked.modifiers.new("Hook", "HOOK").object = keyed(
            scenes.link(bpy.data.objects.new("Empty", None)), (0, 0, 0), (1, 0, 0)
        )
        motion = self.motion()
        for item in (skinned, waving, keys, growing, hooked):
            self.assertTrue(motion.deforms(item), item.name)

    def test_sampled_frames_tell_what_rests_after_all(self):
        from lodestone.bridge import datablock_ids
        from lodestone.bridge.motion.motion_sampling import Motion, frames_to_sample, sample

        self.assertEqual(frames_to_sample(1, 1), [1])
        self.assertEqual(frames_to_sample(1, 2), [1, 2])
        self.assertEqual(frames_to_sample(1, 10), [1, 4, 7, 10])
        flat = ball("Flat")
        flat.modifiers.new("Wave", "WAVE").height = 0.0
        waving = ball("Waving")
        waving.modifiers.new("Wave", "WAVE")
        still = keyed(ball("Still"), (1, 0, 0), (1, 0, 0))
        moving = keyed(ball("Moving"), (0, 0, 0), (5, 0, 0))
        scene = bpy.context.scene
        scene.frame_set(7)
        found = sample(scene, bpy.context.view_layer, frames_to_sample(1, 20))
        self.assertEqual(scene.frame_current, 7)
        self.assertEqual(found["still_shape"], [datablock_ids.uid_of("object", flat)])
        self.assertEqual(found["still_place"], [datablock_ids.uid_of("object", still)])
        motion = Motion(found)
        self.assertFalse(motion.deforms(flat) or motion.moves(still))
        self.assertTrue(motion.deforms(waving) and motion.moves(moving))


class Built(unittest.TestCase):
    def setUp(self):
        self.scene = scenes.fresh()
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.store = Path(folder.name)
        street = scenes.collection("Street", self.scene.collection)
        for i in range(3):
            ball(f"Stone {i}", street, (3 * i, 0, 0))
        keyed(ball("Car", street), (0, 3, 0), (9, 3, 0))
        ball("Flag", street, (0, 6, 0)).modifiers.new("Wave", "WAVE")

    def build(self, frame):
        from lodestone.core.native import lodestone_native as native
        from lodestone.engines import extract_engine

        self.scene.frame_set(frame)
        request = extract_engine.Request(compare=True)
        extraction = extract_engine.extract_now(self.scene, request)
        self.assertEqual(request.differences, [])
        with extraction.model as model:
            report = model.build(str(self.store), native.BuildOptions())
            summaries = [model.object_summary(item) for item in model.objects()]
            return report.built, {s.name: s.representation_count for s in summaries}

    def test_levels_of_what_rests_and_of_what_moves_are_built_once(self):
        built, counts = self.build(1)
        self.assertEqual(built, 2)  # one stone, which the car is too, and the street
        self.assertEqual(counts["Flag"], 1)
        self.assertGreater(counts["Street"], 1)  # of the stones alone
        self.assertEqual(counts["Scene in motion"], 1)
        self.assertEqual(self.build(10), (0, counts))
        self.assertEqual(self.build(20), (0, counts))

    def test_as_set_levels_are_made_for_every_frame(self):
        self.scene.lodestone.deforming = "FRAME"
        _, counts = self.build(1)
        self.assertGreater(counts["Flag"], 1)
        self.assertNotIn("Scene in motion", counts)
        built, _ = self.build(10)
        self.assertGreater(built, 0)

    def test_an_instanced_collection_that_moves_inside_has_no_levels_of_its_own(self):
        hidden = scenes.collection("Ride")
        keyed(ball("Seat", hidden), (0, 0, 0), (2, 0, 0))
        ball("Post", hidden)
        scenes.instance("Ride 1", hidden, (0, 20, 0))
        _, counts = self.build(1)
        self.assertEqual(counts["Ride"], 1)
        self.assertEqual(counts["Ride in motion"], 1)  # the post beside it rests
        built, again = self.build(10)
        self.assertEqual((built, again), (0, counts))


def mesh_of(glb):
    """(indices, positions) of the one mesh in a store's file, as bytes."""
    length = int.from_bytes(glb[12:16], "little")
    header, binary = json.loads(glb[20 : 20 + length]), glb[28 + length :]

    def part(accessor):
        view = header["bufferViews"][header["accessors"][accessor]["bufferView"]]
        start = view.get("byteOffset", 0)
        return binary[start : start + view["byteLength"]]

    primitives = [item for mesh in header["meshes"] for item in mesh["primitives"]]
    return (
        [part(item["indices"]) for item in primitives],
        [part(item["attributes"]["POSITION"]) for item in primitives],
    )


class Followed(unittest.TestCase):
    def setUp(self):
        self.scene = scenes.fresh()
        self.scene.frame_end = 20
        self.flag = ball("Flag")
        self.flag.modifiers.new("Wave", "WAVE").height = 0.4
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def build(self, frame, store="store"):
        """The report, the problems, and [(indices, positions)] of the flag from the finest on."""
        from lodestone.core.native import lodestone_native as native
        from lodestone.engines import extract_engine

        self.scene.frame_set(frame)
        request = extract_engine.Request(with_poses=True)
        extraction = extract_engine.extract_now(self.scene, request)
        self.assertEqual(self.scene.frame_current, frame)
        store = self.folder / store
        with extraction.model as model:
            report = model.build(str(store), native.BuildOptions(poses=request.poses.models))
            request.poses.close()
            problems = [(item.object, item.code, item.severity) for item in model.problems()]
        description = json.loads((store / "tileset.json").read_text())
        for item in description["asset"]["extras"]["lodestone"]["objects"]:
            if item["name"] == "Flag":
                files = [store / "r" / f"{r['hash']}.glb" for r in item["representations"]]
                return report, problems, [mesh_of(file.read_bytes()) for file in files]
        self.fail("no flag")

    def test_a_camera_bound_to_a_marker_is_the_one_of_its_frame(self):
        from lodestone.engines import extract_engine

        second = bpy.data.objects.new("Second", bpy.data.cameras.new("Second"))
        second.location = (0, 0, 20)
        scenes.link(second)
        for frame, item in ((1, self.scene.camera), (10, second)):
            self.scene.timeline_markers.new(item.name, frame=frame).camera = item
        for frame, height in ((1, 10.0), (12, 20.0)):
            self.scene.frame_set(frame)
            request = extract_engine.Request([("", None)], with_poses=True)
            extract_engine.extract_now(self.scene, request).model.close()
            self.assertTrue(request.poses.models, "other frames were not looked at")
            request.poses.close()
            self.assertEqual(request.frames[0][0].position[2], height)

    def test_every_frame_has_the_triangles_of_one_collapse_where_its_surface_is(self):
        report, problems, first = self.build(3)
        self.assertEqual((report.built, problems), (1, []))
        self.assertGreater(len(first), 3)
        report, _, last = self.build(17)
        self.assertEqual(report.built, 0)
        self.assertEqual([level[0] for level in first], [level[0] for level in last])
        for before, after in zip(first, last):
            self.assertNotEqual(before[1], after[1])
        self.assertEqual(self.build(17, "backwards")[2], last)
        self.assertEqual(self.build(3, "backwards")[2], first)

    def test_what_wears_a_view_layers_override_is_followed(self):
        material = bpy.data.materials.new("Override")
        material.use_nodes = True
        nodes = material.node_tree.nodes
        picture = nodes.new("ShaderNodeTexImage")
        picture.image = bpy.data.images.new("Picture", 4, 4)
        picture.image.generated_type = "COLOR_GRID"
        links = material.node_tree.links
        links.new(picture.outputs["Color"], nodes["Principled BSDF"].inputs["Base Color"])
        coordinates = nodes.new("ShaderNodeTexCoord")  # a place in the mesh for every corner
        links.new(coordinates.outputs["Generated"], picture.inputs["Vector"])
        self.scene.view_layers[0].material_override = material
        _, problems, levels = self.build(3)
        self.assertEqual([problem for problem in problems if problem[1] == "not_followed"], [])
        self.assertGreater(len(levels), 1)

    def test_original_has_no_levels(self):
        self.scene.lodestone.deforming = "ORIGINAL"
        report, problems, levels = self.build(3)
        self.assertEqual((report.built, problems, len(levels)), (0, [], 1))

    def test_quads_that_fold_over_are_followed(self):
        # Blender cuts a quad along its other diagonal where it folds: other triangles, same faces
        bpy.data.objects.remove(self.flag)
        points = [(x, y, 0.0) for y in range(9) for x in range(9)]
        quads = [(i, i + 1, i + 10, i + 9) for y in range(8) for i in range(9 * y, 9 * y + 8)]
        self.flag = scenes.link(bpy.data.objects.new("Flag", scenes.mesh("Flag", points, quads)))
        self.flag.shape_key_add(name="Basis")
        folded = self.flag.shape_key_add(name="Folded")
        for i, point in enumerate(folded.data):
            point.co = (1.4 * point.co.x, point.co.y, 0.8 * (i % 3))
            if i % 4 == 0:
                point.co = (point.co.x + 1.5, point.co.y + 1.5, 0.3)
        for frame, value in ((1, 0.0), (20, 1.0)):
            folded.value = value
            folded.keyframe_insert("value", frame=frame)
        _, problems, first = self.build(1)
        _, also, last = self.build(20)
        self.assertEqual(problems + also, [])
        self.assertNotEqual(first[0][0], last[0][0], "the finest is cut as before")
        self.assertEqual([level[0] for level in first[1:]], [level[0] for level in last[1:]])

    def test_what_has_other_faces_in_no_sampled_frame_is_drawn_as_it_is_and_named(self):
        self.flag.modifiers.clear()
        grow = self.flag.modifiers.new("Grow", "BUILD")
        grow.frame_start, grow.frame_duration = 1, 19
        report, problems, levels = self.build(10)
        self.assertEqual((report.built, len(levels)), (0, 1))
        self.assertEqual(problems, [("Flag", "not_followed", 0)])
        _, problems, levels = self.build(20)  # whole: a sampled frame
        self.assertEqual(problems, [])
        self.assertGreater(len(levels), 1)

    def test_a_picture_leaves_the_frame_and_the_scene_as_they_were(self):
        self.flag.location.z = -60
        scene = self.scene
        scene.render.engine = "LODESTONE_POVRAY"
        scene.lodestone.antialias = "OFF"
        scene.render.filepath = str(self.folder / "picture.png")
        bpy.ops.wm.save_as_mainfile(filepath=str(self.folder / "file.blend"))
        scene.frame_set(7)
        bpy.ops.render.render(write_still=True)
        self.assertEqual(scene.frame_current, 7)
        self.assertTrue((self.folder / "picture.png").is_file())
        from lodestone.core.session.addon_session import addon_session
        from lodestone.engines import render_engine

        poses = addon_session().part(render_engine.RenderState).poses
        self.assertEqual(poses, {})
        used = addon_session().renders.get(scene.name)
        self.assertEqual(used.triangles_placed, 1280)
        self.assertLess(used.triangles, 200)


class Shaded(unittest.TestCase):
    """What moves on a floor: in a still picture it shades it, in frames it does not."""

    def shares(self, **how):
        """The shares of the sky's light that the scene of POV-Ray names."""
        scene = scenes.fresh()
        with tempfile.TemporaryDirectory() as folder:
            scene.world = bpy.data.worlds.new("World")
            scenes.link(
                bpy.data.objects.new(
                    "Floor", scenes.mesh("Floor", [(-9, -9, 0), (9, -9, 0), (0, 9, 0)], [(0, 1, 2)])
                )
            )
            keyed(scenes.cube("Crate", size=3.0), (0, 0, 1.5), (1, 0, 1.5))
            scene.render.engine = "LODESTONE_POVRAY"
            scene.render.resolution_x = scene.render.resolution_y = 16
            scene.render.filepath = folder + "/"
            scene.frame_start = scene.frame_end = scene.frame_current
            scene.lodestone.keep_scene_files = "ALWAYS"
            bpy.ops.wm.save_as_mainfile(filepath=folder + "/shaded.blend")
            bpy.ops.render.render(**how)
            texts = [path.read_text() for path in Path(folder).glob("lodestone/**/*.inc")]
            return {share for text in texts for share in re.findall(r"ambient rgb <[^>]*>", text)}

    def test_a_still_picture_has_the_shade_that_frames_have_not(self):
        still, frame = self.shares(), self.shares(animation=True)
        self.assertGreater(len(still), len(frame) + 3)


if __name__ == "__main__":
    unittest.main()
