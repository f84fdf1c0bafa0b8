# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that say why they are greyed."""


class Polled:
    """Mixed in before bpy.types.Operator."""

    @classmethod
    def refused(cls, context):
        """Why it cannot run here, a sentence without its full stop; "" when it can."""
        raise NotImplementedError

    @classmethod
    def poll(cls, context):
        why = cls.refused(context)
        if why:
            cls.poll_message_set(why)
        return not why


class InObjectMode(Polled):
    @classmethod
    def refused(cls, context):
        return "" if context.mode == "OBJECT" else "Leave Edit Mode first"
