# SPDX-License-Identifier: GPL-3.0-or-later
"""The designer's decision about how finely one placement is drawn."""

import math
from typing import NamedTuple

ANY_LEVEL = 0xFFFFFFFF
_MOST_IMPORTANCE = 64.0


class Decision(NamedTuple):
    """A decision. `coarsest`: the largest LOD number that it may be drawn with; 0: its original,
    and those of all in it. `apart`: it is in no group's stand-in. `pinned`: always `coarsest`,
    nothing finer."""

    importance: float = 1.0
    coarsest: int = ANY_LEVEL
    apart: bool = False
    pinned: bool = False

    def inside(self, outer: "Decision") -> "Decision":
        """Both at once, of one placement: what is decided about a collection and about what
        instances it."""
        importance = self.importance * outer.importance
        made = Decision(
            min(max(importance, 1.0 / _MOST_IMPORTANCE), _MOST_IMPORTANCE),
            min(self.coarsest, outer.coarsest),
            self.apart or outer.apart,
        )
        if outer.pinned or self.pinned:  # the instancer has the last word
            pin = outer if outer.pinned else self
            made = made._replace(coarsest=pin.coarsest, pinned=True)
        return UNDECIDED if made == UNDECIDED else made


UNDECIDED = Decision()


def decision(use: str, coarsest: int, importance: float, pin: int = -1) -> Decision:
    """The decision that the settings of an object or collection ask for, as property_groups.py
    names them. `pin`: the LOD number it is always drawn with, below 0: none. UNDECIDED itself where
    they ask for nothing."""
    limits = {"ORIGINAL": 0, "EXCLUDE": 0, "LIMIT": coarsest}
    if math.isnan(importance):  # Blender lets scripts and drivers set it so
        importance = 1.0
    importance = min(max(importance, 1.0 / _MOST_IMPORTANCE), _MOST_IMPORTANCE)
    limit = pin if pin >= 0 else limits.get(use, ANY_LEVEL)
    made = Decision(importance, limit, use == "EXCLUDE", pin >= 0)
    return UNDECIDED if made == UNDECIDED else made
