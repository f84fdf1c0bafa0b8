# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the Properties tabs under our engine: what Cycles users look for is there, once."""

import inspect
import re
import unittest

import addon_utils
import bpy

import blender_scenes as scenes

ENGINE = "LODESTONE_POVRAY"
# What each tab must offer, by its headings; panels inside others are named with their own
WANTED = {
    "render": {"Sampling", "Simplify", "Levels of Detail", "Problems", "Film", "Performance"}
    | {"Threads", "Scene Files", "Color Management"},
    "output": {"Format", "Frame Range", "Output", "Metadata", "Post Processing"},
    "view_layer": {"View Layer"},
    "scene": {"Scene", "Units"},
    "world": {"Surface"},
    "material": {"Surface", "Viewport Display"},
}
FOREIGN = ("EEVEE_", "CYCLES_", "DATA_PT_EEVEE", "RENDER_PT_eevee", "RENDER_PT_opengl")
JOINED_FROM_EEVEE = {"EEVEE_MATERIAL_PT_viewport_settings"}  # of the viewport, for every engine


def panels(tab, **members):
    """{class name: heading} of the panels that a tab shows; members are those of its context."""
    found = {}
    with bpy.context.temp_override(**members):
        for name in dir(bpy.types):
            panel = getattr(bpy.types, name, None)
            if getattr(panel, "bl_space_type", "") != "PROPERTIES":
                continue
            if getattr(panel, "bl_context", "") != tab:
                continue
            try:
                shown = panel.poll(bpy.context) if hasattr(panel, "poll") else True
            except (AttributeError, TypeError):  # of a member this tab never has
                shown = False
            if shown:
                found[name] = panel
    return {name: panel.bl_label for name, panel in found.items() if _in_sight(panel, found)}


def _in_sight(panel, found):
    """A panel within another is seen only where that one is."""
    parent = getattr(panel, "bl_parent_id", "")
    return not parent or (parent in found and _in_sight(found[parent], found))


class Panels(unittest.TestCase):
    def setUp(self):
        self.scene = scenes.fresh()
        self.scene.render.engine = ENGINE
        self.scene.world = bpy.data.worlds.new("World")

    def of_object(self, tab, item, **members):
        bpy.context.view_layer.objects.active = item
        return panels(tab, object=item, active_object=item, **members)

    def of_light(self, kind):
        data = bpy.data.lights.new(kind, kind)
        item = scenes.link(bpy.data.objects.new(kind, data))
        return self.of_object("data", item, light=data)

    def test_every_tab_has_what_it_needs_and_nothing_twice(self):
        material = scenes.material("Paint")
        item = scenes.cube()
        item.data.materials.append(material)
        members = {"world": self.scene.world, "material": material, "object": item}
        for tab, wanted in WANTED.items():
            with self.subTest(tab):
                found = panels(tab, **members)
                headings = [heading for heading in found.values() if heading]
                self.assertLessEqual(wanted, set(headings), found)
                for heading in wanted:
                    self.assertEqual(headings.count(heading), 1, (heading, found))

    def test_no_tab_shows_a_panel_of_another_engine(self):
        camera = self.scene.camera
        material = scenes.material("Paint")
        members = {"world": self.scene.world, "material": material, "object": camera}
        members |= {"camera": camera.data, "light": bpy.data.lights.new("Key", "SPOT")}
        for tab in (*WANTED, "data", "object"):
            names = set(panels(tab, **members)) - JOINED_FROM_EEVEE
            self.assertEqual([name for name in names if name.startswith(FOREIGN)], [], tab)

    def test_lights_have_their_size_and_their_beam(self):
        for kind in ("POINT", "SUN", "SPOT", "AREA"):
            found = self.of_light(kind)
            headings = list(found.values())
            self.assertEqual(headings.count("Light"), 1, (kind, found))
            beam = int(kind in {"SPOT", "AREA"})
            self.assertEqual(headings.count("Beam Shape"), beam, kind)
            self.assertEqual([h for h in headings if h in {"Area Shape", "Spot Shape"}], [])

    def test_cameras_have_lens_and_depth_of_field(self):
        camera = self.scene.camera
        headings = list(self.of_object("data", camera, camera=camera.data).values())
        for heading in ("Lens", "Camera", "Depth of Field", "Aperture", "Background Images"):
            self.assertEqual(headings.count(heading), 1, heading)

    def test_meshes_particles_and_collections_keep_their_tabs(self):
        item = scenes.cube()
        data = set(self.of_object("data", item, mesh=item.data).values())
        self.assertLessEqual({"UV Maps", "Normals", "Vertex Groups", "Color Attributes"}, data)
        item.modifiers.new("Particles", "PARTICLE_SYSTEM")
        system = item.particle_systems[0]
        particle = self.of_object(
            "particle", item, particle_system=system, particle_settings=system.settings
        )
        self.assertLessEqual({"Emission", "Render"}, set(particle.values()))
        visible = set(self.of_object("object", item).values())
        wanted = {"Transform", "Visibility", "Ray Visibility", "Levels of Detail"}
        self.assertLessEqual(wanted, visible)
        camera = set(self.of_object("object", self.scene.camera).values())
        self.assertNotIn("Ray Visibility", camera)  # there is nothing of it to see
        kept = scenes.collection("Kept", self.scene.collection)
        layer = bpy.context.view_layer.layer_collection.children["Kept"]
        bpy.context.view_layer.active_layer_collection = layer
        tab = panels("collection", collection=kept)
        self.assertLessEqual({"Restrictions", "Levels of Detail"}, set(tab.values()))

    def test_grease_pencil_has_no_surface_of_ours(self):
        data = bpy.data.grease_pencils.new("Line")
        item = scenes.link(bpy.data.objects.new("Line", data))
        material = bpy.data.materials.new("Ink")
        bpy.data.materials.create_gpencil_data(material)
        names = self.of_object("material", item, material=material)
        self.assertEqual([name for name in names if name.startswith("LODESTONE_")], [])

    def test_other_engines_keep_their_tabs(self):
        for engine in ("BLENDER_EEVEE", "BLENDER_WORKBENCH"):
            self.scene.render.engine = engine
            ours = [name for name in panels("render") if name.startswith("LODESTONE_")]
            both = ["LODESTONE_RENDER_PT_levels", "LODESTONE_RENDER_PT_levels_view"]
            self.assertEqual(ours, both, engine)
            members = {"material": scenes.material("Paint"), "object": scenes.cube()}
            names = panels("material", **members)
            self.assertEqual([name for name in names if name.startswith("LODESTONE_")], [])

    def test_disabled_and_enabled_again_it_is_all_there(self):
        before = {tab: panels(tab) for tab in ("render", "output", "view_layer")}
        addon_utils.disable("lodestone", default_set=True)
        scenes.enable()
        self.assertEqual({tab: panels(tab) for tab in before}, before)

    def test_the_surface_shows_what_is_drawn_of_it(self):
        from lodestone.panels.material import DRAWN

        shader = scenes.material("Paint").node_tree.nodes["Principled BSDF"]
        names = [socket.name for socket in shader.inputs]
        shown = [name for name in DRAWN if name in names]
        self.assertGreaterEqual(len(shown), 10)
        self.assertEqual(len(set(DRAWN)), len(DRAWN))
        for name in ("Subsurface", "Sheen", "Anisotropic"):
            self.assertNotIn(name, shown)

    def test_the_surface_shows_each_input_that_is_read(self):
        from lodestone.bridge.nodes.shader_nodes import Shaders
        from lodestone.panels.material import DRAWN

        text = inspect.getsource(Shaders._principled) + inspect.getsource(Shaders._specular)
        read = set(re.findall(r'"([A-Z][A-Za-z ]+)"', text))
        diffuse = {name for name in read if name.startswith("Subsurface")}  # drawn as base color
        self.assertIn("Coat Weight", read)
        self.assertEqual(read - diffuse - set(DRAWN), set())

    def test_presets_set_what_they_say(self):
        settings = self.scene.lodestone
        for key, expected in (("DRAFT", 8.0), ("PREVIEW", 2.0), ("EXACT", 0.0), ("FINAL", 1.0)):
            self.assertEqual(bpy.ops.lodestone.levels_preset(preset=key), {"FINISHED"})
            self.assertEqual(settings.pixel_error_render, expected)

    def test_labels_and_tooltips_follow_blenders_style(self):
        for name in dir(bpy.types):
            kind = getattr(bpy.types, name, None)
            if not name.startswith("LODESTONE_") or not hasattr(kind, "bl_rna"):
                continue
            label = getattr(kind, "bl_label", "")
            words = [word for word in label.split() if word not in {"of", "in", "the", "and", "to"}]
            capital = all(word[0].isupper() or word[0] == "(" for word in words)
            self.assertTrue(capital or "(" in label, (name, label))
            texts = [getattr(kind, "bl_description", "") or ""]
            if "_PG_" in name or "_OT_" in name:
                own = [p for p in kind.bl_rna.properties if p.identifier not in {"rna_type"}]
                texts += [p.description for p in own if p.is_registered or "_PG_" in name]
            for text in texts:
                self.assertFalse(text.endswith("."), (name, text))


if __name__ == "__main__":
    unittest.main()
