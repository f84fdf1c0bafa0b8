# SPDX-License-Identifier: GPL-3.0-or-later
"""Stock panels under our render engine: without joining them, Properties tabs would be empty."""

import bpy

ENGINE = "LODESTONE_POVRAY"

# Panels of things our pictures do not have
_LEFT_OUT = {
    "RENDER_PT_freestyle",
    "VIEWLAYER_PT_filter",
    "VIEWLAYER_PT_layer_passes",
    "VIEWLAYER_PT_freestyle",
    "RENDER_PT_simplify_greasepencil",
    "DATA_PT_lens_panorama",
}
# Surface, world and light settings exist only as panels of the engines that brought them
_BORROWED = {
    "EEVEE_MATERIAL_PT_context_material",
    "EEVEE_MATERIAL_PT_surface",
    "EEVEE_WORLD_PT_surface",
    "DATA_PT_EEVEE_light",
}


def _panels():
    for name in dir(bpy.types):
        panel = getattr(bpy.types, name, None)
        engines = getattr(panel, "COMPAT_ENGINES", None)
        if not isinstance(engines, set) or name.startswith("LODESTONE_"):
            continue
        if name in _BORROWED or ("BLENDER_RENDER" in engines and name not in _LEFT_OUT):
            yield panel


def register():
    for panel in _panels():
        panel.COMPAT_ENGINES.add(ENGINE)


def unregister():
    for name in dir(bpy.types):
        engines = getattr(getattr(bpy.types, name, None), "COMPAT_ENGINES", None)
        if isinstance(engines, set):
            engines.discard(ENGINE)
