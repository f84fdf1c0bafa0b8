# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards framing and depth: our camera against Blender's own, our pictures against Cycles'."""

import math
import tempfile
import unittest
from pathlib import Path

import bpy
from mathutils import Vector

import blender_scenes

CASES = {
    "horizontal": {"sensor_fit": "HORIZONTAL"},
    "auto portrait": {"size": (36, 64)},
    "vertical": {"sensor_fit": "VERTICAL", "sensor_height": 20.0},
    "shift": {"shift_x": 0.2, "shift_y": -0.1},
    "pixel aspect": {"aspect": (2.0, 1.0)},
    "portrait, shift, aspect": {"size": (36, 64), "shift_x": 0.1, "aspect": (1.0, 1.5)},
    "orthographic, shift": {"type": "ORTHO", "ortho_scale": 7.0, "shift_x": 0.3, "shift_y": 0.1},
}


def with_case(scene, changes):
    """Gives the scene's camera new data and the picture its shape."""
    data = bpy.data.cameras.new("Case")
    render = scene.render
    render.resolution_x, render.resolution_y = changes.get("size", (64, 36))
    render.pixel_aspect_x, render.pixel_aspect_y = changes.get("aspect", (1.0, 1.0))
    for key, value in changes.items():
        if key not in {"size", "aspect"}:
            setattr(data, key, value)
    scene.camera.data = data
    return data


class Camera(unittest.TestCase):
    def setUp(self):
        self.scene = blender_scenes.fresh()
        blender_scenes.cube()
        self.camera = self.scene.camera
        self.camera.location = (3.0, -4.0, 5.0)
        self.camera.rotation_euler = (0.9, 0.2, 0.7)
        self.camera.scale = (2.0, 2.0, 2.0)  # Blender ignores it

    def extracted(self):
        extraction, request = blender_scenes.extract(False, [("", None)])
        extraction.model.close()
        return request.frames[0]

    def test_every_corner_is_where_blender_has_it(self):
        from lodestone.bridge.scene.scene_camera import Frame, view_plane

        for name, changes in CASES.items():
            with self.subTest(name):
                data = with_case(self.scene, changes)
                width, height, x, y = view_plane(data, Frame.of(self.scene.render))
                corners = data.view_frame(scene=self.scene)
                depth = -corners[0].z if data.type != "ORTHO" else 1.0
                expected = sorted((c.x / depth, c.y / depth) for c in corners)
                actual = sorted(
                    (x + u * width, y + v * height) for u in (-0.5, 0.5) for v in (-0.5, 0.5)
                )
                for (ex, ey), (ax, ay) in zip(expected, actual):
                    self.assertAlmostEqual(ex, ax, places=5)
                    self.assertAlmostEqual(ey, ay, places=5)

    def test_a_point_falls_on_its_pixel(self):
        from bpy_extras.object_utils import world_to_camera_view

        with_case(self.scene, {"shift_x": 0.15})
        bpy.context.view_layer.update()
        camera, (width, height) = self.extracted()
        self.assertEqual((width, height), (64, 36))
        for point in (Vector((0, 0, 0)), Vector((1, 2, 0.5)), Vector((-1, 0.3, 1))):
            expected = world_to_camera_view(self.scene, self.scene.camera, point)
            offset = point - Vector(camera.position)
            right, up, ahead = (Vector(v) for v in (camera.right, camera.up, camera.direction))
            normal = right.cross(up)
            offset *= normal.dot(ahead) / normal.dot(offset)
            u = (offset - ahead).dot(right) / right.length_squared + 0.5
            v = (offset - ahead).dot(up) / up.length_squared + 0.5
            self.assertTrue(math.isclose(u, expected.x, abs_tol=1e-5), point)
            self.assertTrue(math.isclose(v, expected.y, abs_tol=1e-5), point)

    def test_a_named_camera_and_size_are_used(self):
        data = bpy.data.cameras.new("Far")
        data.type = "ORTHO"
        blender_scenes.link(bpy.data.objects.new("Far", data))
        extraction, request = blender_scenes.extract(False, [("Far", (10, 20)), ("", None)])
        extraction.model.close()
        (far, far_size), (own, own_size) = request.frames
        self.assertEqual((far.name, far.orthographic, far_size), ("Far", True, (10, 20)))
        self.assertEqual((own.name, own.orthographic, own_size), ("Camera", False, (64, 36)))

    def test_a_mesh_was_now_and_then_read_as_a_camera_among_thousands_of_objects(self):
        data = blender_scenes.cube_mesh()
        for number in range(3000):
            blender_scenes.cube(f"Cube {number}", (2 * number, 0, 0), data=data)
        data = bpy.data.cameras.new("Second")
        blender_scenes.link(bpy.data.objects.new("Second", data))
        for _ in range(5):
            extraction, _ = blender_scenes.extract(False)
            with extraction.model as model:
                self.assertEqual([c.name for c in model.cameras()], ["Camera", "Second"])

    def test_the_first_camera_of_a_store_was_not_the_scenes_own(self):
        for name in ("Before", "Zoo"):  # the scene's own is "Camera"
            blender_scenes.link(bpy.data.objects.new(name, bpy.data.cameras.new(name)))
        for own, others in (("Camera", ["Before", "Zoo"]), ("Zoo", ["Before", "Camera"])):
            bpy.context.scene.camera = bpy.data.objects[own]
            extraction, _ = blender_scenes.extract(False)
            with extraction.model as model:
                found = [c.name for c in model.cameras()]
            self.assertEqual(found, [own, *others])

    def test_scaled_and_sheared_parents_do_not_change_the_view(self):
        parent = blender_scenes.link(bpy.data.objects.new("Parent", None))
        parent.scale, parent.rotation_euler = (3.0, 0.5, 1.0), (0.3, 0.2, 0.1)
        self.camera.parent = parent
        bpy.context.view_layer.update()
        camera, _ = self.extracted()
        right, up, ahead = (Vector(v) for v in (camera.right, camera.up, camera.direction))
        self.assertAlmostEqual(right.length, 36 / 50, places=5)
        self.assertAlmostEqual(up.length, 36 / 50 * 36 / 64, places=5)
        # As view3d and Cycles: the axes of the world matrix, each of length 1
        matrix = self.camera.matrix_world.normalized()
        self.assertLess((right.normalized() - matrix.col[0].to_3d()).length, 1e-5)
        self.assertLess((ahead + matrix.col[2].to_3d()).length, 1e-5)

    def test_the_focus_is_where_blender_has_it(self):
        data = self.camera.data
        data.dof.use_dof = True
        data.dof.focus_distance, data.dof.aperture_fstop, data.lens = 4.0, 2.0, 80.0
        camera, _ = self.extracted()
        self.assertAlmostEqual(camera.focus_distance, 4.0, places=5)
        self.assertAlmostEqual(camera.aperture, 0.080 / 2.0, places=6)
        target = blender_scenes.link(bpy.data.objects.new("Target", None))
        target.location = (1.0, 2.0, 0.5)
        data.dof.focus_object = target
        bpy.context.view_layer.update()
        camera, _ = self.extracted()
        ahead = -self.camera.matrix_world.col[2].to_3d().normalized()
        depth = (target.location - self.camera.location).dot(ahead)
        self.assertAlmostEqual(camera.focus_distance, depth, places=4)

    def test_what_pictures_lack_is_named(self):
        data = self.camera.data
        data.type = "PANO"
        self.scene.render.use_motion_blur = self.scene.render.use_multiview = True
        extraction, _ = blender_scenes.extract(False, [("", None)])
        extraction.model.close()
        codes = {problem.code for problem in extraction.problems}
        self.assertLessEqual({"camera_panoramic", "motion_blur", "stereo"}, codes)

    def test_a_camera_that_clips_was_silent(self):
        self.camera.data.clip_start = 3.0
        extraction, _ = blender_scenes.extract(False, [("", None)])
        extraction.model.close()
        self.assertIn("clip_start", {problem.code for problem in extraction.problems})

    def test_a_missing_camera_is_named(self):
        with self.assertRaisesRegex(Exception, 'no camera "Near"'):
            blender_scenes.extract(False, [("Near", None)])


class GlowingBalls(unittest.TestCase):
    """The same ones, rendered by both engines."""

    def setUp(self):
        self.scene = scene = blender_scenes.fresh()
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        bpy.ops.wm.save_as_mainfile(filepath=str(self.folder / "file.blend"))
        scene.world = None
        scene.lodestone.pixel_error_render = 0.0
        render = scene.render
        render.image_settings.file_format = "OPEN_EXR"
        render.image_settings.color_depth = "32"
        cycles = scene.cycles
        cycles.device, cycles.samples = "CPU", 64
        cycles.use_denoising = cycles.use_adaptive_sampling = False
        cycles.pixel_filter_type, render.filter_size = "BOX", 0.01
        self.glow = bpy.data.materials.new("Glow")
        self.glow.use_nodes = True
        tree = self.glow.node_tree
        tree.nodes.clear()
        emission = tree.nodes.new("ShaderNodeEmission")
        output = tree.nodes.new("ShaderNodeOutputMaterial")
        tree.links.new(emission.outputs[0], output.inputs["Surface"])

    def ball(self, location, radius):
        if "Ball" not in bpy.data.meshes:
            bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3, radius=1.0)
            made = bpy.context.object
            made.data.name = "Ball"
            made.data.materials.append(self.glow)
        else:
            data = bpy.data.meshes["Ball"]
            made = blender_scenes.link(bpy.data.objects.new("Ball", data))
        made.location, made.scale = location, (radius, radius, radius)

    def render(self, engine):
        """(width, height, brightness of each pixel, lowest row first)."""
        self.scene.render.engine = engine
        self.scene.render.filepath = str(self.folder / f"{engine}.exr")
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(self.scene.render.filepath)
        (width, height), pixels = image.size, list(image.pixels)
        bpy.data.images.remove(image)
        return width, height, pixels[::4]


class Pictures(GlowingBalls):
    def test_eleven_balls_are_where_cycles_has_them_in_all_seven_cases(self):
        from bpy_extras.object_utils import world_to_camera_view

        places = [(x, y) for y in (-0.3, 0.0, 0.3) for x in (-0.36, -0.12, 0.12, 0.36)][:11]
        self.scene.camera.rotation_euler = (0.5, 0.3, 0.2)
        self.scene.lodestone.antialias = "REFERENCE"
        worst = 0.0
        for name, changes in CASES.items():
            for item in [item for item in bpy.data.objects if item.type == "MESH"]:
                bpy.data.objects.remove(item)
            data = with_case(self.scene, changes)
            bpy.context.view_layer.update()
            frame = data.view_frame(scene=self.scene)
            matrix = self.scene.camera.matrix_world
            points = []
            for number, (u, v) in enumerate(places):
                right, up = frame[0] - frame[3], frame[0] - frame[1]
                at = (frame[0] + frame[2]) / 2 + u * right + v * up
                depth = 5.0 + 0.3 * number
                at = at * depth / -at.z if data.type != "ORTHO" else Vector((at.x, at.y, -depth))
                radius = 0.02 * (depth if data.type != "ORTHO" else 7.0)
                points.append(matrix @ at)
                self.ball(points[-1], radius)
            bpy.context.view_layer.update()
            pictures = [self.render(engine) for engine in ("LODESTONE_POVRAY", "CYCLES")]
            for point in points:
                at = world_to_camera_view(self.scene, self.scene.camera, point)
                ours, theirs = (self.centroid(picture, at.x, at.y) for picture in pictures)
                worst = max(worst, math.dist(ours, theirs))
                with self.subTest(name):
                    self.assertLess(math.dist(ours, theirs), 0.05)
        print(f"worst centroid: {worst:.4f} px")

    def centroid(self, picture, x, y):
        """Of the light within 4.5 pixels of a place (0...1)."""
        width, height, values = picture
        middle = (x * width, y * height)
        total, sums = 0.0, [0.0, 0.0]
        for row in range(height):
            for column in range(width):
                at = (column + 0.5, row + 0.5)
                if math.dist(at, middle) < 4.5:
                    value = values[row * width + column]
                    total += value
                    sums = [sums[0] + value * at[0], sums[1] + value * at[1]]
        self.assertGreater(total, 0.5)
        return (sums[0] / total, sums[1] / total)


if __name__ == "__main__":
    unittest.main()
