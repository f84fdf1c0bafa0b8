# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards which lights a glowing thing becomes: few of each thing, and no limit of a scene."""

import math
import unittest

import bpy
from mathutils import Matrix, Vector

import blender_scenes as scenes
from lodestone.bridge.scene import glowing_faces
from lodestone.bridge.scene.glowing_faces import Glow, Glows, Part
from lodestone.core.native import lodestone_native as native
from lodestone.core.problems import Problems

KEY = ("material", "", "Glow")


def box(size, sides="xXyYzZ", closed=True):
    """The part of a box about the origin with some of its sides (capitals: the positive one)."""
    found = []
    for side in sides:
        axis = "xyz".index(side.lower())
        others = [i for i in range(3) if i != axis]
        corners = []
        for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
            p = Vector()
            p[axis] = (1 if side.isupper() else -1) * size[axis] / 2
            p[others[0]], p[others[1]] = a * size[others[0]] / 2, b * size[others[1]] / 2
            corners.append(p)
        found.append(((corners[0], corners[1], corners[2]), (corners[0], corners[2], corners[3])))
    return Part(KEY, (2.0, 1.0, 1.0), tuple(found), closed)


def lights(glow, world=None, most=glowing_faces.MOST_LIGHTS):
    glows = Glows()
    glows.add(glow, world or Matrix(), "thing")
    return glows.lights(None, Problems(), most)


class GlowingFaces(unittest.TestCase):
    def test_a_cube_is_one_bulb_of_its_area(self):
        (found,) = lights(Glow((box((0.2, 0.2, 0.2)),)))
        self.assertEqual(found.kind, native.LightKind.POINT)
        self.assertAlmostEqual(found.power, 2.0 * math.pi * 0.24, places=6)
        self.assertAlmostEqual(found.radius, math.sqrt(0.24 / (4.0 * math.pi)), places=6)

    def test_the_panes_of_a_lantern_are_one_bulb_in_its_middle(self):
        """Each is a part of its own, open on both sides; what they send inward stays inside."""
        panes = Glow(tuple(box((0.2, 0.2, 0.3), side, False) for side in "xXyY"))
        (found,) = lights(panes, Matrix.Translation((5.0, 6.0, 7.0)))
        self.assertEqual(found.kind, native.LightKind.POINT)
        self.assertLess((Vector(found.position) - Vector((5.0, 6.0, 7.0))).length, 1e-6)
        self.assertAlmostEqual(found.power, 2.0 * math.pi * 4 * 0.06, places=6)

    def test_a_thin_box_and_a_row_keep_their_sides(self):
        self.assertEqual(len(lights(Glow((box((0.9, 0.5, 0.05)),)))), 6)
        row = Glow(tuple(box((0.2, 0.2, 2.0), side, False) for side in "xXyY"))
        self.assertEqual(len(lights(row)), 8)
        self.assertEqual(len(lights(Glow((box((1, 1, 1), "z", False),)))), 2)

    def test_lit_windows_of_a_house_are_no_lantern(self):
        """They became one bulb in the house, which cast no shadow then."""
        panes = []
        for side in "xXyY":
            for along, up in ((-3.0, -3.0), (-3.0, 3.0), (3.0, -3.0), (3.0, 3.0)):
                part = box((1.0, 1.0, 1.0), side, False)
                way = 4.5 if side.isupper() else -4.5
                place = (way, along, up) if side.lower() == "x" else (along, way, up)
                move = Matrix.Translation(place)
                moved = tuple(tuple(tuple(move @ p for p in t) for t in s) for s in part.sides)
                panes.append(Part(KEY, part.radiance, moved, False))
        found = lights(Glow(tuple(panes)))
        self.assertEqual({light.kind for light in found}, {native.LightKind.AREA})
        self.assertEqual(len(found), 32)

    def test_a_place_moves_turns_and_scales_lights(self):
        """As if they were fitted there: where all axes are alike that is spared."""
        glow = Glow((box((0.9, 0.5, 0.05)),))
        place = Matrix.Translation((1.0, 2.0, 3.0)) @ Matrix.Rotation(0.7, 4, (1, 2, 3))
        place = place @ Matrix.Scale(2.5, 4)
        moved = lights(glow, place)
        fitted = [light for _, made in glowing_faces._fitted_parts(glow, place) for light in made]
        self.assertEqual(len(moved), 6)
        for a in moved:
            b = min(fitted, key=lambda b: (Vector(a.position) - Vector(b.position)).length)
            self.assertAlmostEqual(a.power, 2.0 * b.power, places=4)
            self.assertLess((Vector(a.position) - Vector(b.position)).length, 1e-4)
            self.assertGreater(Vector(a.direction).dot(Vector(b.direction)), 0.9999)
            self.assertAlmostEqual(Vector(a.direction).length, 1.0, places=5)
        bent = lights(glow, Matrix.Diagonal((1.0, 2.0, 1.0, 1.0)))
        self.assertAlmostEqual(bent[0].power, 2.0 * 4.0 * 0.9 * 1.0, places=5)
        for place in (Matrix.Scale(0.0, 4), Matrix.Scale(float("nan"), 4)):
            lights(glow, place)  # nothing throws

    def test_hundreds_of_things_all_shine_the_strongest_first(self):
        glows, problems = Glows(), Problems()
        glow = Glow((box((0.1, 0.1, 0.1)),))
        for i in range(400):
            glows.add(glow, Matrix.Translation((i, 0.0, 0.0)) @ Matrix.Scale(1 + i, 4), "ball")
        found = glows.lights(None, problems)
        self.assertEqual(len(found), 400)
        self.assertEqual(tuple(problems), ())
        powers = [light.power for light in found]
        self.assertEqual(powers, sorted(powers, reverse=True))
        self.assertEqual(len(glows.lights(None, problems, 30)), 30)
        self.assertEqual([problem.code for problem in problems], ["glow"])

    def test_a_mesh_of_panes_is_read_as_a_lantern(self):
        scenes.fresh()
        bpy.ops.mesh.primitive_cube_add(size=0.3)
        shown = bpy.context.object
        material = bpy.data.materials.new("Glow")
        shown.data.materials.append(material)

        class Look:
            radiance = (3.0, 3.0, 3.0)

        glow = glowing_faces.glow_of(shown, [material], [Look()])
        (found,) = lights(glow)
        self.assertEqual(found.kind, native.LightKind.POINT)


if __name__ == "__main__":
    unittest.main()
