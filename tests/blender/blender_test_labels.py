# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the looks of our panels: at the width that Properties have on a 1920 pixel screen, no name
of a control ends in dots."""

import tempfile
import unittest
from types import SimpleNamespace

import blf
import bpy

import blender_scenes as scenes

# Pixels at scale 1, as measured on screen: the column of names beside values that can be animated
# and those that cannot, words beside a checkbox, and a whole row
NAME, NAME_PLAIN, CHECKBOX, ROW = 88, 96, 107, 265


def panels():
    """All of ours in Properties that draw something of their own, by name."""
    named = [name for name in dir(bpy.types) if name.startswith("LODESTONE_") and "_PT_" in name]
    kinds = {name: getattr(bpy.types, name) for name in named}
    places = {name: (kind.bl_space_type, kind.bl_region_type) for name, kind in kinds.items()}
    own = {name for name, kind in kinds.items() if kind.draw.__module__.startswith("lodestone.")}
    return {name: kinds[name] for name in own if places[name] == ("PROPERTIES", "WINDOW")}


def shown(kind):
    """Whether a panel is drawn in the context of now."""
    try:
        return not hasattr(kind, "poll") or kind.poll(bpy.context)
    except (AttributeError, TypeError):  # of a member that only the context of its tab has
        return False


class Layout:
    """Stands for bpy.types.UILayout: notes what is drawn, as (words, pixels that there are)."""

    def __init__(self, drawn, width=ROW, decorated=True):
        self.drawn, self.width, self.use_property_decorate = drawn, width, decorated
        self.parent, self.active, self.operators = None, True, {}

    def _part(self, width=None, heading=""):
        self.drawn.append((heading, NAME))
        part = Layout(self.drawn, width or self.width, self.use_property_decorate)
        part.parent, part.operators = self, self.operators
        return part

    def separator(self):
        pass

    def row(self, heading="", **_):
        return self._part(heading=heading)

    column = row

    def box(self):
        return self._part()

    def split(self, factor=0.5, **_):
        """Its first column is for names, the second for values."""
        part = self._part()
        widths = [round(self.width * factor), round(self.width * (1.0 - factor))]
        part.row = part.column = lambda **_: self._part(widths.pop(0))
        return part

    def label(self, text="", icon="NONE", **_):
        self.drawn.append((text, self.width - (20 if icon != "NONE" else 0)))

    def prop(self, owner, name, text=None, **_):
        known = owner.bl_rna.properties[name]
        width = NAME if self.use_property_decorate else NAME_PLAIN
        if known.type == "BOOLEAN":
            width = CHECKBOX
        self.drawn.append((known.name if text is None else text, width))

    def prop_menu_enum(self, owner, name, text="", **_):
        self.drawn.append((text, NAME))

    def operator(self, name, *_, **__):
        self.operators[name] = self
        return SimpleNamespace()

    operator_menu_enum = operator

    def __getattr__(self, name):
        if not name.startswith("template_"):
            raise AttributeError(name)
        return lambda *_, **__: self.drawn.append(("", self.width))  # without words of ours

    def looks_active(self):
        return self.active and (self.parent is None or self.parent.looks_active())


class Labels(unittest.TestCase):
    def setUp(self):
        scene = scenes.fresh()
        scene.render.engine = "LODESTONE_POVRAY"
        scenes.sun()
        self.lens = scenes.link(bpy.data.objects.new("Lens", None))
        self.ball = scenes.cube("Ball", data=scenes.bumpy_mesh())
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        bpy.ops.wm.save_as_mainfile(filepath=f"{self.folder.name}/labels.blend")
        self.scene = bpy.context.scene
        self.seen = set()  # names of panels that were drawn
        blf.size(0, 11, 72)

    def too_long(self, item, **members):
        """The names that are cut off; members are those that the context of a tab has besides the
        item."""
        bpy.context.view_layer.objects.active = item
        found = []
        with bpy.context.temp_override(object=item, active_object=item, **members):
            for name, kind in panels().items():
                if not shown(kind):
                    continue
                drawn = []
                layout = Layout(drawn)
                kind.draw(SimpleNamespace(layout=layout), bpy.context)
                if drawn or layout.operators:
                    self.seen.add(name)
                found += [
                    (name, text, blf.dimensions(0, text)[0], width)
                    for text, width in drawn
                    if blf.dimensions(0, text)[0] > width
                ]
        return found

    def tabs(self):
        """An item and the members of its context for each tab that has panels of ours."""
        material = scenes.material("Paint")
        self.ball.data.materials.append(material)
        yield self.ball, {"material": material, "material_slot": self.ball.material_slots[0]}
        self.scene.world = bpy.data.worlds.new("World")
        yield self.ball, {"world": self.scene.world}
        yield self.scene.camera, {"camera": self.scene.camera.data}
        for kind in ("POINT", "SUN", "SPOT", "AREA"):
            data = bpy.data.lights.new(kind, kind)
            yield scenes.link(bpy.data.objects.new(kind, data)), {"light": data}
        yield self.ball, {"collection": scenes.collection("Kept", self.scene.collection)}

    def test_no_name_is_cut_off_at_the_usual_width(self):
        self.assertEqual(self.too_long(self.ball), [])
        for item, members in self.tabs():
            with self.subTest(item.name):
                self.assertEqual(self.too_long(item, **members), [])
        bpy.context.view_layer.objects.active = self.lens
        bpy.ops.lodestone.detail_lens_enable()
        self.lens.empty_display_type = "PLAIN_AXES"
        self.assertEqual(self.too_long(self.lens), [])
        # Each panel was drawn with something that it is about: a new one may need its own in tabs.
        # A heading of other panels draws nothing itself.
        headings = {getattr(kind, "bl_parent_id", "") for kind in panels().values()}
        self.assertEqual(set(panels()) - self.seen - headings, set())

    def test_no_name_is_cut_off_whatever_is_set(self):
        bpy.ops.lodestone.update_levels()
        self.scene.lodestone.budget_render = 1
        self.scene.lodestone.antialias = "FINAL"
        for pixel_error in (0.0, 16.0):
            self.scene.lodestone.pixel_error_render = pixel_error
            self.assertEqual(self.too_long(self.ball), [])
        self.scene.lodestone.use_levels = False
        self.assertEqual(self.too_long(self.ball), [])

    def test_what_works_in_the_popover_does_not_look_as_if_it_did_not(self):
        layout = Layout([])
        popover = bpy.types.LODESTONE_VIEW3D_PT_false_colors
        shading = SimpleNamespace(type="SOLID")
        context = SimpleNamespace(
            scene=self.scene,
            window_manager=bpy.context.window_manager,
            engine=self.scene.render.engine,
            space_data=SimpleNamespace(type="VIEW_3D", shading=shading),
        )
        popover.draw(SimpleNamespace(layout=layout), context)
        self.assertEqual(context.window_manager.lodestone_overlay.mode, "NONE")
        self.assertTrue(layout.operators["lodestone.false_color_picture"].looks_active())
        self.assertFalse(layout.operators["lodestone.read_levels"].looks_active())
