# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards framing: our camera against Blender's own view_frame() in every sensor fit."""

import math
import unittest

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
        from lodestone.bridge.camera import Frame, view_plane

        for name, changes in CASES.items():
            with self.subTest(name):
                data = bpy.data.cameras.new("Case")
                render = self.scene.render
                render.resolution_x, render.resolution_y = changes.get("size", (64, 36))
                render.pixel_aspect_x, render.pixel_aspect_y = changes.get("aspect", (1.0, 1.0))
                for key, value in changes.items():
                    if key not in {"size", "aspect"}:
                        setattr(data, key, value)
                width, height, x, y = view_plane(data, Frame.of(render))
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

        self.scene.camera.data.shift_x = 0.15
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

    def test_a_missing_camera_is_named(self):
        with self.assertRaisesRegex(Exception, 'no camera "Near"'):
            blender_scenes.extract(False, [("Near", None)])


if __name__ == "__main__":
    unittest.main()
