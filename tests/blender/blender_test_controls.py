# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards that whatever a designer can set or press has a tooltip, its choices too, and is explained
in the add-on's pages."""

import unittest
from pathlib import Path

import bpy

import blender_scenes as scenes

ADDON = Path(__file__).resolve().parents[2] / "blender_addon"
PAGES = (ADDON / "README.md", *sorted((ADDON / "docs").glob("*.md")))
# Buttons that are explained by what they stand beside, not by their own label
BESIDE = {
    "ignore_problem": "is copied, or ignored",
    "inherit_control": "sets it back",
    "levels_preset": "**Presets**",
    "levels_preset_add": "the + in the list",
    "restore_problems": "what is ignored",
    "screen_lens_add": "**Screen lenses**",
    "screen_lens_remove": "**Screen lenses**",
    "build_levels": "Without a window",
}
BLENDERS = {"align", "location", "rotation"}  # of all that adds objects
# What shares a name, or is one of a pair, by the words that explain it
NAMED = {
    "use_pin_render": "Pin in Renders",
    "use_pin_viewport": "Pin in Viewports",
    "pin_render": "Pin in Renders",
    "pin_viewport": "Pin in Viewports",
    "pixel_error_viewport": "*Viewport* below it",
    "budget_render": "**Budget**: megabytes",
    "budget_viewport": "*Viewport*: millions of triangles",
    "coarsest": "Never Coarser Than* a level",
    "collection": "one collection",
    "force_lod": "Force LOD",
    "use_force_lod": "Force LOD",
    "enabled": "lens",
    "x": "in shares of its width and height",
    "y": "in shares of its width and height",
    "keep_scene_files": "*Scene Files*: Keep",
    "use_levels": "the checkbox in the header when it is off",
    "radius": "the wheel changes its radius",
}


def properties(of, built_in):
    """Ours that are not hidden: of a property group, or of an operator."""
    return [p for p in of if p.identifier not in built_in and not p.is_hidden]


def groups():
    """One of each kind of property group of ours."""
    scene = bpy.context.scene
    camera, empty = scene.camera, scenes.link(bpy.data.objects.new("Empty", None))
    manager = bpy.context.window_manager
    return (
        scene.lodestone,
        scene.collection.lodestone,
        empty.lodestone,
        empty.lodestone.lens,
        camera.data.lodestone,
        camera.data.lodestone.screen_lenses.add(),
        manager.lodestone_overlay,
    )


def controls():
    """{where it is: property} of everything that is drawn."""
    found = {}
    for group in groups():
        for one in properties(group.bl_rna.properties, {"rna_type", "name"}):
            found[f"{group.bl_rna.identifier}.{one.identifier}"] = one
    return found


def operators():
    """{name: RNA type}; those Blender shows nowhere have the option INTERNAL."""
    return {
        name: getattr(bpy.ops.lodestone, name).get_rna_type() for name in dir(bpy.ops.lodestone)
    }


class Controls(unittest.TestCase):
    def setUp(self):
        scenes.fresh()

    def test_every_control_has_a_tooltip_and_so_has_each_of_its_choices(self):
        found = controls()
        self.assertGreater(len(found), 40, sorted(found))
        for where, one in found.items():
            self._tells(where, one.description)
            for item in one.enum_items if one.type == "ENUM" else ():
                self._tells(f"{where}: {item.identifier}", item.description)

    def test_every_button_has_a_tooltip_and_so_has_what_it_asks(self):
        found = operators()
        self.assertGreater(len(found), 20, sorted(found))
        for name, kind in found.items():
            self._tells(name, kind.description)
            for one in properties(kind.properties, {"rna_type"}):
                if one.identifier not in BLENDERS:
                    self._tells(f"{name}.{one.identifier}", one.description)

    def test_the_pages_explain_every_control_and_every_button(self):
        told = " ".join(" ".join(page.read_text("utf-8") for page in PAGES).split())
        for where, one in controls().items():
            words = NAMED.get(one.identifier, one.name)
            self.assertTrue(words in told, (where, words))
        for name, kind in operators().items():
            words = BESIDE.get(name, kind.name)
            self.assertTrue(words in told, (name, words))

    def test_what_the_test_asks_of_each_it_misses_in_one_without(self):
        class LODESTONE_PG_silent(bpy.types.PropertyGroup):
            value: bpy.props.IntProperty(name="Value")

        bpy.utils.register_class(LODESTONE_PG_silent)
        try:
            (one,) = properties(LODESTONE_PG_silent.bl_rna.properties, {"rna_type", "name"})
            with self.assertRaises(AssertionError):
                self._tells("value", one.description)
        finally:
            bpy.utils.unregister_class(LODESTONE_PG_silent)

    def _tells(self, where, text):
        self.assertGreater(len(text.split()), 2, where)
        self.assertFalse(text.endswith("."), (where, text))  # as Blender's own


if __name__ == "__main__":
    unittest.main()
