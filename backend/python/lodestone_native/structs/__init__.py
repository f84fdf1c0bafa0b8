# SPDX-License-Identifier: GPL-3.0-or-later
"""The C structs, field by field as in lodestone.h, and the ways in and out of them."""

from .base import Object, Sized, record, text_in, text_out
from .build import BuildOptions, BuildReport
from .cut import (
    Budget,
    BudgetReport,
    Choice,
    CutSummary,
    LevelUse,
    RayChoice,
    RaySummary,
    Reason,
)
from .grouping import LooseOptions, LooseReport, StructureOptions, StructureReport
from .material import Bake, BakeStep, Material, Picture, Texture
from .measure import Attributes, MeasureOptions, SimplifyOptions, SimplifyReport
from .mesh import FacesView, MeshView, StrandsView, UvProjection
from .picture import Difference, ExportReport, PovrayOptions, PovrayReport
from .scene import (
    Camera,
    Light,
    ObjectInfo,
    ObjectSummary,
    Occurrence,
    Placement,
    Problem,
    Representation,
    Totals,
    World,
)
from .view import Lens, Modifiers, ScreenLens, View

__all__ = (
    "Attributes",
    "Bake",
    "BakeStep",
    "Budget",
    "BudgetReport",
    "BuildOptions",
    "BuildReport",
    "Camera",
    "Choice",
    "CutSummary",
    "Difference",
    "ExportReport",
    "FacesView",
    "Lens",
    "LevelUse",
    "Light",
    "LooseOptions",
    "LooseReport",
    "Material",
    "MeasureOptions",
    "MeshView",
    "Modifiers",
    "Object",
    "ObjectInfo",
    "ObjectSummary",
    "Occurrence",
    "Picture",
    "Placement",
    "PovrayOptions",
    "PovrayReport",
    "Problem",
    "RayChoice",
    "RaySummary",
    "Reason",
    "Representation",
    "ScreenLens",
    "SimplifyOptions",
    "SimplifyReport",
    "Sized",
    "StrandsView",
    "StructureOptions",
    "StructureReport",
    "Texture",
    "Totals",
    "UvProjection",
    "View",
    "World",
    "record",
    "text_in",
    "text_out",
)
