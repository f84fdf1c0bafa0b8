# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties > Render > Problems: one row per cause, as Check Scene or the last F12 found them."""

import bpy
from bpy.types import Panel

from ..core import problem_causes
from ..core.problems import ERROR, INFO, WARNING
from ..core.session.addon_session import addon_session
from ..operators import problems as operators
from . import EnginePanel

ICONS = {ERROR: "CANCEL", WARNING: "ERROR", INFO: "INFO"}
ROWS = 50  # a panel with thousands would stop the window; Copy All has every one
_ADDON = __package__.rpartition(".")[0]


class LODESTONE_RENDER_PT_problems(EnginePanel, Panel):
    bl_label = "Problems"
    bl_context = "render"

    def draw_header_preset(self, context):
        found = operators.split(context)
        row = self.layout.row(align=True)
        if found is not None:
            for severity in (ERROR, WARNING):
                count = found.count(severity)
                if count:
                    row.label(text=f"{count:,}", icon=ICONS[severity])
            if not found.count(ERROR) and not found.count(WARNING):
                row.label(text="", icon="CHECKMARK")
        row.operator("lodestone.copy_problems", text="", icon="COPYDOWN", emboss=False).key = ""

    def draw(self, context):
        layout = self.layout
        row = layout.row(align=True)
        row.operator("lodestone.check_scene", icon="VIEWZOOM")
        found = operators.split(context)
        if found is None:
            layout.label(text="Not checked yet: Check Scene, or render")
            return
        column = layout.column(align=True)
        for cause in found.shown[:ROWS]:
            _draw_cause(context, column, cause)
        more = len(found.shown) - ROWS
        if more > 0:
            column.label(text=f"and {more:,} more: Copy lists them", icon="BLANK1")
        if not found.shown:
            column.label(text="No problems", icon="CHECKMARK")
        exact = problem_causes.exact_line(
            *addon_session().checks.get(context.scene.name).exact_materials
        )
        if exact:
            column.label(text=exact, icon="MATERIAL")
        if found.ignored:
            row = layout.row(align=True)
            row.label(text=f"{len(found.ignored):,} ignored", icon="HIDE_ON")
            row.operator("lodestone.restore_problems", text="Restore")


def _draw_cause(context, column, cause):
    row = column.row(align=True)
    row.label(text=cause.sentence, icon=ICONS[cause.severity])
    if cause.code == "povray_missing":
        row.operator("preferences.addon_show", text="", icon="PREFERENCES").module = _ADDON
    if operators.remedy(context, cause.code):
        row.operator("lodestone.draw_faster", text="Faster").code = cause.code
    if cause.objects:
        select = row.operator("lodestone.select_problem", text="", icon="RESTRICT_SELECT_OFF")
        select.key = cause.key
    row.operator("lodestone.copy_problems", text="", icon="COPYDOWN").key = cause.key
    if not cause.about_setup:
        row.operator("lodestone.ignore_problem", text="", icon="HIDE_OFF").key = cause.key


register, unregister = bpy.utils.register_classes_factory((LODESTONE_RENDER_PT_problems,))
