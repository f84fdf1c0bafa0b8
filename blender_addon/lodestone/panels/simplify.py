# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties > Render > Simplify: the stock panels once more, to stand below Sampling as in Cycles.

Blender orders panels as they are registered, and its own come before those of any add-on.
"""

import bpy
from bl_ui import properties_render as stock
from bpy.types import Panel

from . import EnginePanel


class LODESTONE_RENDER_PT_simplify(EnginePanel, Panel):
    bl_label = "Simplify"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    draw_header = stock.RENDER_PT_simplify.draw_header
    draw = stock.RENDER_PT_simplify.draw


class LODESTONE_RENDER_PT_simplify_viewport(EnginePanel, Panel):
    bl_label = "Viewport"
    bl_parent_id = "LODESTONE_RENDER_PT_simplify"
    bl_context = "render"

    draw = stock.RENDER_PT_simplify_viewport.draw


class LODESTONE_RENDER_PT_simplify_render(EnginePanel, Panel):
    bl_label = "Render"
    bl_parent_id = "LODESTONE_RENDER_PT_simplify"
    bl_context = "render"

    draw = stock.RENDER_PT_simplify_render.draw


_CLASSES = (
    LODESTONE_RENDER_PT_simplify,
    LODESTONE_RENDER_PT_simplify_viewport,
    LODESTONE_RENDER_PT_simplify_render,
)
register, unregister = bpy.utils.register_classes_factory(_CLASSES)
