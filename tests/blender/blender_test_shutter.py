# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards Coarser When Moving or Dark: what moves while the shutter is open is told to the cut."""

import unittest

import blender_scenes as scenes
from lodestone.core.native import lodestone_native as native


def moved(item, to, frame=2):
    """From where it is in frame 1."""
    item.keyframe_insert("location", frame=1)
    item.location = to
    item.keyframe_insert("location", frame=frame)
    for curve in item.animation_data.action.fcurves:
        for key in curve.keyframe_points:
            key.interpolation = "LINEAR"


class Shutter(unittest.TestCase):
    def setUp(self):
        self.scene = scenes.fresh()
        self.scene.lodestone.coarser_moving_dark = True
        self.scene.frame_set(1)
        scenes.cube("Still")
        self.mover = scenes.cube("Mover", (2, 0, 0))

    def motions(self):
        """({what is drawn: how much coarser for its motion}, modifiers)"""
        self.scene.frame_set(1)
        extraction, request = scenes.extract(compare=False, cameras=[("", None)])
        with extraction.model as model:
            (camera, size), modifiers = request.frames[0], request.modifiers[0]
            view = native.View(camera, *size, 1.0, 0, modifiers=modifiers)
            with native.Cut(model, view) as cut:
                count = len(cut.choices())
                found = {cut.choice_path(n): cut.reason(n).motion for n in range(count)}
        return {path.split("/")[-1]: motion for path, motion in found.items()}, modifiers

    def test_what_moves_is_coarser_and_what_rests_is_not(self):
        moved(self.mover, (2, 3, 0))
        found, modifiers = self.motions()
        self.assertTrue(modifiers.when_moving and modifiers.when_dark)
        self.assertEqual(found["Still"], 1.0)
        self.assertGreater(found["Mover"], 1.0)
        self.assertEqual(self.scene.frame_current_final, 1.0)

    def test_a_longer_shutter_is_coarser_and_a_closed_one_is_not(self):
        moved(self.mover, (2, 3, 0))
        found = []
        for shutter in (0.0, 0.25, 1.0):
            self.scene.render.motion_blur_shutter = shutter
            found.append(self.motions()[0]["Mover"])
        self.assertEqual(found[0], 1.0)
        self.assertLess(found[0], found[1])
        self.assertLess(found[1], found[2])

    def test_a_moving_camera_moves_everything(self):
        self.scene.camera.location = (0, 0, 10)
        moved(self.scene.camera, (5, 0, 10))
        found, modifiers = self.motions()
        self.assertAlmostEqual(modifiers.closing.position[0], 2.5, 4)
        self.assertGreater(min(found.values()), 1.0)

    def test_a_resting_scene_and_one_switched_off_are_as_ever(self):
        found, _ = self.motions()
        self.assertEqual(set(found.values()), {1.0})
        self.scene.lodestone.coarser_moving_dark = False
        moved(self.mover, (2, 3, 0))
        self.assertFalse(self.motions()[1].when_moving)

    def test_what_is_scaled_to_nothing_has_no_motion_and_no_traceback(self):
        self.mover.scale = (0, 0, 0)
        moved(self.mover, (2, 3, 0))
        found, _ = self.motions()
        self.assertEqual(found["Still"], 1.0)


if __name__ == "__main__":
    unittest.main()
