# SPDX-License-Identifier: GPL-3.0-or-later
"""Levels of Detail > Comparison: how far the levels are from the originals, and where most."""

import bpy
from bpy.types import Panel

from ..core import progress_text
from . import EnginePanel
from ..core.session.addon_session import addon_session


class LODESTONE_RENDER_PT_compare(EnginePanel, Panel):
    bl_label = "Comparison"
    bl_parent_id = "LODESTONE_RENDER_PT_levels"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout = self.layout
        layout.operator("lodestone.compare", icon="IMAGE_REFERENCE")
        found = addon_session().comparisons.get(context.scene.name)
        if found is None:
            return
        split = layout.split(factor=0.4)
        names, values = split.column(align=True), split.column(align=True)
        names.label(text="Pixel Error")
        values.label(
            text=f"{found.pixel_error:g} px, {progress_text.count(found.pixels)} pixels covered"
        )
        names.label(text="Mean, Largest")
        values.label(text=f"{255 * found.mean:.2f}, {255 * found.max:.0f} of 255")
        names.label(text="SSIM")
        values.label(text=f"{found.ssim:.4f}")
        for place, (path, share) in enumerate(found.worst):
            names.label(text="" if place else "Differ Most")
            text = f"{progress_text.percent(share, 1.0)}   {path.rsplit('/', 1)[-1]}"
            values.operator("lodestone.select_object", text=text, emboss=False).path = path


register, unregister = bpy.utils.register_classes_factory((LODESTONE_RENDER_PT_compare,))
