# SPDX-License-Identifier: GPL-3.0-or-later
"""The verbs of batch.py, a class each: a new one is a file here and a row in VERBS; where it makes
pictures, also a row of MAKERS in ../picture_making.py."""

from .build_levels import Build
from .compare_levels import Compare
from .export_scenes import Export
from .render_pictures import Render
from .verb import Verb

# In the order of the help text
VERBS: tuple[Verb, ...] = (Build(), Render(), Export(), Compare())


def verb_of(name: str) -> Verb:
    """The verb that the command line and jobs call by this name."""
    return next(verb for verb in VERBS if verb.name == name)
