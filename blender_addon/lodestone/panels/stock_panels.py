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
_LEFT_OUT_PREFIXES = ("VIEWLAYER_PT_freestyle",)


def _panels():
    """All registered panels of others that say for which engines they are. Not by the names of
    bpy.types: asking for each of its thousands takes as long as all else of registering."""
    found, seen = bpy.types.Panel.__subclasses__(), set()
    while found:
        panel = found.pop()
        if panel in seen:
            continue
        seen.add(panel)
        found += panel.__subclasses__()
        ours = panel.__name__.startswith("LODESTONE_")
        if panel.is_registered and not ours and isinstance(_engines(panel), set):
            yield panel


def _engines(panel):
    return getattr(panel, "COMPAT_ENGINES", None)


def _joins(panel):
    # The node editor's copy of a panel shares the very set of its original
    original = panel.__name__.removeprefix("NODE_")
    if original in _LEFT_OUT or original.startswith(_LEFT_OUT_PREFIXES):
        return False
    return "BLENDER_RENDER" in _engines(panel)


def register():
    for panel in filter(_joins, _panels()):
        _engines(panel).add(ENGINE)


def unregister():
    for panel in _panels():
        _engines(panel).discard(ENGINE)
