# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards coming and going: enabling and disabling leaves nothing behind, also when it fails."""

import importlib
import pkgutil
import unittest

import addon_utils
import bpy

import blender_scenes

OWNERS = (bpy.types.Scene, bpy.types.Collection, bpy.types.Object)


def traces():
    """Everything of ours that Blender knows now."""
    names = [name for name in dir(bpy.types) if name.startswith("LODESTONE_")]
    names += [owner.__name__ for owner in OWNERS if hasattr(owner, "lodestone")]
    names += [f"bpy.ops.{name}" for name in dir(bpy.ops.lodestone)]
    for name in dir(bpy.types):
        engines = getattr(getattr(bpy.types, name, None), "COMPAT_ENGINES", ())
        if "LODESTONE_POVRAY" in engines:
            names.append(f"{name}.COMPAT_ENGINES")
    for handlers in bpy.app.handlers:
        for handler in handlers if isinstance(handlers, list) else ():
            if "lodestone" in handler.__module__:
                names.append(handler.__module__)
    return names


class Register(unittest.TestCase):
    def tearDown(self):
        blender_scenes.enable()

    def test_on_and_off_twice_leaves_nothing(self):
        for _ in range(2):
            blender_scenes.enable()
            self.assertIn("Scene", traces())
            addon_utils.disable("lodestone", default_set=True)
            self.assertEqual(traces(), [])

    def test_each_class_for_blender_is_registered(self):
        blender_scenes.enable()
        addon = importlib.import_module("lodestone")
        kinds = (bpy.types.Panel, bpy.types.Operator, bpy.types.Menu, bpy.types.UIList)
        kinds += (bpy.types.PropertyGroup,)
        missing = []
        for folder in ("operators", "panels", "properties", "viewport"):
            part = importlib.import_module(f"{addon.__name__}.{folder}")
            for file in pkgutil.iter_modules(part.__path__):
                module = importlib.import_module(f"{part.__name__}.{file.name}")
                for name, value in vars(module).items():
                    ours = isinstance(value, type) and value.__module__ == module.__name__
                    if ours and issubclass(value, kinds) and not value.is_registered:
                        missing.append(f"{module.__name__}.{name}")
        self.assertEqual(missing, [])

    def test_disabling_forgets_the_session(self):
        from lodestone.core.session.addon_session import addon_session

        blender_scenes.enable()
        blender_scenes.fresh()
        blender_scenes.cube()
        bpy.ops.lodestone.check_scene()
        session = addon_session()
        session.changed_shapes.note(["Cube"])
        self.assertIn("Scene", session.checks)
        addon_utils.disable("lodestone", default_set=True)
        self.assertIsNot(addon_session(), session)
        blender_scenes.enable()
        self.assertEqual(addon_session().checks, {})
        self.assertEqual(addon_session().changed_shapes.names(), set())

    def test_a_part_that_fails_leaves_nothing_and_is_seen(self):
        addon_utils.disable("lodestone", default_set=True)
        addon = importlib.import_module("lodestone")
        panels = importlib.import_module("lodestone.panels")
        original = panels.register

        def fail():
            raise RuntimeError("a part that fails")

        panels.register = fail
        try:
            with self.assertRaisesRegex(RuntimeError, "a part that fails"):
                addon.register()
        finally:
            panels.register = original
        self.assertEqual(traces(), [])

    def test_jobs_without_a_window_register_what_files_hold_alone(self):
        addon_utils.disable("lodestone", default_set=True)
        addon = importlib.import_module("lodestone")
        addon.register(data_only=True)
        try:
            self.assertIn("Scene", traces())
            self.assertEqual([name for name in traces() if "_OT_" in name or "ops." in name], [])
            self.assertEqual([name for name in traces() if "_PT_" in name], [])
        finally:
            addon.unregister()
        self.assertEqual(traces(), [])

    def test_stock_panels_join_the_engine(self):
        blender_scenes.enable()
        joined = [name for name in traces() if name.endswith("COMPAT_ENGINES")]
        for panel in (
            "RENDER_PT_format",
            "RENDER_PT_color_management",
            "DATA_PT_lens",
            "VIEWLAYER_PT_layer",
            "LODESTONE_MATERIAL_PT_surface",
        ):
            self.assertIn(f"{panel}.COMPAT_ENGINES", joined)

    def test_opening_a_file_changes_nothing_in_it(self):
        blender_scenes.fresh()
        blender_scenes.cube()
        self.assertFalse(any("lodestone" in item.keys() for item in bpy.data.objects))


if __name__ == "__main__":
    unittest.main()
