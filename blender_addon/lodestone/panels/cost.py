# SPDX-License-Identifier: GPL-3.0-or-later
"""Levels of Detail > Time and Memory: what the last picture was expected to take, and took."""

import bpy
from bpy.types import Panel

from ..core import progress_text
from ..core.session.addon_session import addon_session
from . import EnginePanel


class LODESTONE_RENDER_PT_cost(EnginePanel, Panel):
    bl_label = "Time and Memory"
    bl_parent_id = "LODESTONE_RENDER_PT_levels"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout = self.layout
        render = addon_session().renders.get(context.scene.name)
        if render is None or not render.actual_s:
            layout.label(text="Render a picture to see what it takes")
            return
        split = layout.split(factor=0.3)
        names, values = split.column(align=True), split.column(align=True)
        names.label(text="Time")
        expected, took = seconds(render.predicted_s), seconds(render.actual_s)
        values.label(text=f"expected {expected}, took {took}")
        names.label(text="Memory")
        expected = progress_text.memory(render.predicted_bytes)
        values.label(text=f"expected {expected}, took {progress_text.memory(render.actual_bytes)}")


def seconds(value):
    """0.8 s, 12 s, 2:05."""
    if value < 10.0:
        return f"{value:.1f} s"
    return f"{value:.0f} s" if value < 60.0 else progress_text.clock(value)


register, unregister = bpy.utils.register_classes_factory((LODESTONE_RENDER_PT_cost,))
