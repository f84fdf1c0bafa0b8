# SPDX-License-Identifier: GPL-3.0-or-later
"""Stock panels under our render engine: without joining them, Properties tabs would be empty."""

import bpy

from . import ENGINE

# Panels of what our pictures do not have, and those that ours stand for
_LEFT_OUT = {
    "DATA_PT_area",
    "DATA_PT_camera_stereoscopy",
    "DATA_PT_falloff_curve",
    "DATA_PT_lens_panorama",
    "DATA_PT_light",
    "DATA_PT_preview",
    "DATA_PT_spot",
    "MATERIAL_PT_freestyle_line",
    "RENDER_PT_freestyle",
    "RENDER_PT_gpencil",
    "RENDER_PT_output_views",
    "RENDER_PT_simplify",
    "RENDER_PT_simplify_greasepencil",
    "RENDER_PT_simplify_render",
    "RENDER_PT_simplify_viewport",
    "RENDER_PT_stereoscopy",
    "VIEWLAYER_PT_filter",
    "VIEWLAYER_PT_layer_passes",
}
_LEFT_OUT_PREFIXES = ("LODESTONE_", "VIEWLAYER_PT_freestyle")


def _panels():
    for name in dir(bpy.types):
        panel = getattr(bpy.types, name, None)
        engines = getattr(panel, "COMPAT_ENGINES", None)
        # The node editor's copy of a panel shares the very set of its original
        original = name.removeprefix("NODE_")
        if not isinstance(engines, set) or original.startswith(_LEFT_OUT_PREFIXES):
            continue
        if "BLENDER_RENDER" in engines and original not in _LEFT_OUT:
            yield panel


def register():
    for panel in _panels():
        panel.COMPAT_ENGINES.add(ENGINE)


def unregister():
    for name in dir(bpy.types):
        if name.startswith("LODESTONE_"):
            continue
        engines = getattr(getattr(bpy.types, name, None), "COMPAT_ENGINES", None)
        if isinstance(engines, set):
            engines.discard(ENGINE)
