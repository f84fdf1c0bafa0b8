# SPDX-License-Identifier: GPL-3.0-or-later
"""Preferences: which POV-Ray, and whether everything Lodestone needs is there."""

import bpy
from bpy.props import StringProperty

from .core.native import lodestone_native as native
from .core.session.addon_session import addon_session
from .core.store import store_path


class FoundPrograms(dict[str, list[tuple[str, str]]]):
    """The lines of status() by program; part of the session."""


def povray_program() -> str:
    """The user's choice; "" means $LODESTONE_POVRAY, else the PATH. Works where the add-on was
    registered without being enabled (batch jobs), too."""
    addon = bpy.context.preferences.addons.get(__package__)
    preferences = addon.preferences if addon else None
    return bpy.path.abspath(preferences.povray) if preferences and preferences.povray else ""


def status(program: str) -> list[tuple[str, str]]:
    """Lines of (icon, text): what was found, or what to do."""
    lines = []
    try:
        lines.append(("CHECKMARK", f"Library {native.version()}: {native.library_path()}"))
    except native.LodestoneError as error:
        return [("ERROR", f"Library: {error}")]
    try:
        native.rays_check()
        lines.append(("CHECKMARK", "Embree: OK"))
    except native.LodestoneError as error:
        lines.append(("ERROR", f"Embree: {error}"))
    try:
        lines.append(("CHECKMARK", f"POV-Ray: {native.povray_find(program or None)}"))
    except native.LodestoneError as error:
        lines.append(("ERROR", f"POV-Ray: {error}"))
    return lines


def _program_changed(self, context):
    addon_session().drop(FoundPrograms)


class LODESTONE_AP_preferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    povray: StringProperty(
        name="POV-Ray",
        description="The POV-Ray 3.7 program. Empty: the one on the search path",
        subtype="FILE_PATH",
        update=_program_changed,
    )

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "povray")
        program = povray_program()
        found = addon_session().part(FoundPrograms)
        if program not in found:
            found[program] = status(program)
        column = layout.column(align=True)
        for icon, text in found[program]:
            column.label(text=text, icon=icon)
        folder = store_path.store_folder(bpy.data.filepath)
        column.label(text=f"Levels of this file: {folder}", icon="FILE_FOLDER")


_CLASSES = (LODESTONE_AP_preferences,)
register, unregister = bpy.utils.register_classes_factory(_CLASSES)
