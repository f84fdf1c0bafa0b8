# SPDX-License-Identifier: GPL-3.0-or-later
"""Inside a Blender window (see test_window.py): every Properties tab draws under our engine, and
the buttons of the Problems panel work, Ctrl+Z included."""

import os
import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))

import blender_scenes as scenes  # noqa: E402
import window_steps as steps  # noqa: E402

FOLDER = Path(sys.argv[-1])
TABS = ("RENDER", "OUTPUT", "VIEW_LAYER", "SCENE", "WORLD", "COLLECTION", "OBJECT", "MODIFIER")
TABS += ("PARTICLES", "PHYSICS", "CONSTRAINT", "DATA", "MATERIAL", "TEXTURE")
# What each of these must have drawn, wherever it is
OURS = {
    "RENDER": "LODESTONE_RENDER_PT_problems LODESTONE_RENDER_PT_sampling LODESTONE_RENDER_PT_film "
    "LODESTONE_RENDER_PT_levels LODESTONE_RENDER_PT_performance_threads "
    "LODESTONE_RENDER_PT_scene_files LODESTONE_RENDER_PT_levels_view RENDER_PT_context "
    "LODESTONE_RENDER_PT_overrides LODESTONE_RENDER_PT_unseen",
    "OUTPUT": "RENDER_PT_format",
    "VIEW_LAYER": "VIEWLAYER_PT_layer",
    "WORLD": "LODESTONE_WORLD_PT_surface",
    "MATERIAL": "LODESTONE_MATERIAL_PT_surface LODESTONE_MATERIAL_PT_context_material",
}
DATA = {
    "Key": "LODESTONE_LIGHT_PT_light",
    "Cone": "LODESTONE_LIGHT_PT_beam_shape",
    "Camera": "LODESTONE_CAMERA_PT_dof_aperture",
}
PICTURES = {"RENDER", "MATERIAL", "WORLD"}
drawn: set[str] = set()


def watch(kind):
    """Notes every panel that is drawn."""
    original = kind.draw

    def draw(self, context):
        drawn.add(kind.__name__)
        original(self, context)

    kind.draw = draw


def opened():
    """All panels watched, and ours that start closed open."""
    ours = [getattr(bpy.types, name) for name in dir(bpy.types) if name.startswith("LODESTONE_")]
    closed = [p for p in ours if "DEFAULT_CLOSED" in getattr(p, "bl_options", ())]
    for kind in closed:
        children = [p for p in ours if getattr(p, "bl_parent_id", "") == kind.__name__]
        for panel in (*children, kind):
            bpy.utils.unregister_class(panel)
        kind.bl_options = set()
        for panel in (kind, *children):
            bpy.utils.register_class(panel)
    for name in dir(bpy.types):
        kind = getattr(bpy.types, name, None)
        if getattr(kind, "bl_space_type", "") == "PROPERTIES" and "draw" in vars(kind):
            watch(kind)


def noisy(name):
    made = scenes.material(name)
    noise = made.node_tree.nodes.new("ShaderNodeTexNoise")
    shader = made.node_tree.nodes["Principled BSDF"]
    made.node_tree.links.new(noise.outputs["Color"], shader.inputs["Base Color"])
    return made


def make():
    scene = scenes.fresh()
    scene.render.engine = "LODESTONE_POVRAY"
    scene.world = bpy.data.worlds.new("World")
    scene.world.use_nodes = True
    bark = noisy("Bark_old")
    for i in range(12):
        tree = scenes.cube(f"Tree.{i}", (2 * i, 0, 0))
        tree.data.materials.append(bark)
    tree.modifiers.new("Particles", "PARTICLE_SYSTEM")
    tree.data.materials.append(noisy("Unseen"))
    plain = scenes.cube("Plain")
    plain.data.materials.append(scenes.material("Paint"))
    for name, kind in (("Key", "AREA"), ("Cone", "SPOT"), ("Sun", "SUN"), ("Point", "POINT")):
        scenes.link(bpy.data.objects.new(name, bpy.data.lights.new(name, kind)))
    kept = scenes.collection("Kept", scene.collection)
    scenes.instance("Empty", kept)
    for name, data in (
        ("Text", bpy.data.curves.new("Text", "FONT")),
        ("Curve", bpy.data.curves.new("Curve", "CURVE")),
        ("Ball", bpy.data.metaballs.new("Ball")),
        ("Fog", bpy.data.volumes.new("Fog")),
        ("Rig", bpy.data.armatures.new("Rig")),
        ("Grid", bpy.data.lattices.new("Grid")),
        ("Ink", bpy.data.grease_pencils.new("Ink")),
    ):
        scenes.link(bpy.data.objects.new(name, data))
    bpy.ops.wm.save_as_mainfile(filepath=str(FOLDER / "panels.blend"))
    return scene


def properties():
    """The largest area, made a Properties editor."""
    areas = bpy.context.window_manager.windows[0].screen.areas
    area = max(areas, key=lambda a: a.width * a.height)
    area.type = "PROPERTIES"
    return area


def shot(name):
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window, area=window.screen.areas[0]):
        bpy.ops.screen.screenshot(filepath=str(FOLDER / f"{name}.png"))


def has_drawn():
    return bool(drawn)


def window():
    return bpy.context.temp_override(window=bpy.context.window_manager.windows[0])


def show(area, tab):
    """Draws a tab of the active object, where it has such a tab."""
    drawn.clear()
    try:
        area.spaces.active.context = tab
    except TypeError:
        return
    area.tag_redraw()
    yield from steps.wait_until(has_drawn, 10)


def every_tab_draws():
    make()
    opened()
    area = properties()
    yield
    bpy.ops.lodestone.check_scene()
    layer = bpy.context.view_layer
    layer.active_layer_collection = layer.layer_collection.children["Kept"]
    layer.objects.active = bpy.data.objects["Tree.11"]
    bpy.context.scene.render.threads_mode = "FIXED"
    yield
    for tab in TABS:
        yield from show(area, tab)
        assert drawn or tab == "TEXTURE", f"nothing was drawn in {tab}"  # there is no brush
        wanted = set(OURS.get(tab, "").split())
        assert wanted <= drawn, (tab, wanted - drawn, drawn)
        foreign = [name for name in drawn if name.startswith(("EEVEE_MAT", "CYCLES_"))]
        assert not [n for n in foreign if n != "EEVEE_MATERIAL_PT_viewport_settings"], foreign
        if tab in PICTURES:
            shot(tab.lower())


def every_kind_of_object_draws():
    area = properties()
    for name in [item.name for item in bpy.data.objects if "." not in item.name]:
        item = bpy.data.objects[name]
        bpy.context.view_layer.objects.active = item
        yield
        yield from show(area, "MATERIAL")
        yield from show(area, "DATA")
        if name in DATA:
            assert DATA[name] in drawn, (name, drawn)
            shot(f"data_{name.lower()}")


def problems_are_selected_ignored_and_taken_back():
    from lodestone.bridge import ignored_problems
    from lodestone.operators import problems

    def rows():
        return problems.split(bpy.context).shown

    area = properties()
    yield from show(area, "RENDER")
    bpy.ops.lodestone.check_scene()
    (bark,) = [row.key for row in rows() if "Noise" in row.sentence]
    before = len(rows())
    with window():
        bpy.ops.ed.undo_push(message="Before")
        bpy.ops.lodestone.copy_problems(key=bark)
        assert '"Tree.3"' in bpy.context.window_manager.clipboard
        bpy.ops.lodestone.select_problem("EXEC_DEFAULT", True, key=bark)
        assert len(bpy.context.selected_objects) == 12, bpy.context.selected_objects
        bpy.ops.lodestone.ignore_problem("EXEC_DEFAULT", True, key=bark)
    yield from show(area, "RENDER")
    assert len(rows()) == before - 1
    shot("ignored")
    with window():
        bpy.ops.ed.undo()
    yield from show(area, "RENDER")
    assert not ignored_problems.keys(bpy.context.scene)
    assert len(rows()) == before
    assert len(bpy.context.selected_objects) == 12
    with window():
        bpy.ops.ed.undo()
    yield
    assert not bpy.context.selected_objects, bpy.context.selected_objects


def looking_wrote_nothing():
    blocks = (*bpy.data.materials, *bpy.data.lights, *bpy.data.cameras, *bpy.data.worlds)
    written = [repr(item) for item in blocks if "lodestone" in item.keys()]
    assert not written, f"looking stored a group of settings in {written}: see settings_of()"
    yield


def a_missing_povray_offers_the_preferences():
    os.environ["LODESTONE_POVRAY"] = "/nowhere/povray"
    for i in range(60):  # more causes than the panel has rows
        scenes.link(bpy.data.objects.new(f"Fog {i}", bpy.data.volumes.new(f"Fog {i}")))
        paint = noisy(f"Paint {i}")
        paint.node_tree.nodes["Noise Texture"].name = f"Noise {i}"
        scenes.cube(f"Cube {i}").data.materials.append(paint)
    bpy.ops.lodestone.check_scene()
    yield from show(properties(), "RENDER")
    shot("setup")


def the_presets_open():
    drawn.clear()
    with window():
        bpy.ops.wm.call_panel(name="LODESTONE_PT_levels_presets")
    yield
    yield
    assert "LODESTONE_PT_levels_presets" in drawn, drawn
    shot("presets")


steps.run(
    (
        every_tab_draws,
        every_kind_of_object_draws,
        problems_are_selected_ignored_and_taken_back,
        looking_wrote_nothing,
        a_missing_povray_offers_the_preferences,
        the_presets_open,
    )
)
