# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties that hold what the designer decides about objects, collections and cameras."""

from ..bridge import object_decisions


def _decided(self, context):
    object_decisions.tag(self.id_data)


def decided(kind, **options):
    """A property of a kind of bpy.props that pictures and viewports follow at once, and that a
    library override may change."""
    return kind(update=_decided, override={"LIBRARY_OVERRIDABLE"}, **options)
