# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers of the C interface, by name."""

from enum import IntEnum


class Status(IntEnum):
    OK = 0
    INVALID_ARGUMENT = 1
    OUT_OF_MEMORY = 2
    INTERNAL = 3
    CANCELLED = 4
    STALE_ID = 5
    IO = 10
    BAD_FILE = 11
    RAYS_UNAVAILABLE = 20
    POVRAY_MISSING = 30
    POVRAY_FAILED = 31


class Stage(IntEnum):
    """What a long call is doing now."""

    NONE = 0
    EXTRACT = 1
    MEASURE = 2
    SIMPLIFY = 3
    GROUP = 4
    STORE = 5
    CHOOSE = 6
    EXPORT = 7
    PARSE = 8
    TRACE = 9


class Role(IntEnum):
    AUTOMATIC = 0
    ENVIRONMENT = 1
    ORDINARY = 2


class RayClass(IntEnum):
    """Bits; what is seen through glass is seen by the camera."""

    CAMERA = 1
    REFLECTION = 2
    SHADOW = 4
    RADIOSITY = 8


class Kind(IntEnum):
    MESH = 1
    BOX = 3
    ELLIPSOID = 4
    COMPOSITE = 7
    ASSEMBLY = 8


class LensShape(IntEnum):
    SPHERE = 0
    BOX = 1


class LensFilter(IntEnum):
    """What a lens does to what is not in its list."""

    ALL = 0
    REFINE = 1
    SHOW = 2


class Criterion(IntEnum):
    """What a level is judged by, and so what a view's Pixel Error means."""

    RESOLUTION = 0
    FEATURE = 1
    AREA = 2
    DISTANCE = 3


class OffScreen(IntEnum):
    """How fine things are that the picture does not show."""

    FULL = 0  # as if it showed them
    REFLECTED = 1  # as far as it shows their shadows, and mirrors or refracts them
    SHADOWS = 2  # as far as it shows their shadows: images of them may be coarse


class Rays(IntEnum):
    """Classes of rays that may meet coarser representations than the camera's rays."""

    REFLECTION = 1
    SHADOW = 2
    RADIOSITY = 4


class Met(IntEnum):
    """Why a class of rays meets what it meets of a choice."""

    OFF = 0  # the class was not asked for, or does not meet it: as the camera's
    OWN = 1  # a coarser representation of its own
    GROUP = 2  # a stand-in for a group around it
    NEED = 3  # as the camera's: nothing coarser is good enough
    SHAPE = 4  # as the camera's: a stand-in would shadow or mirror its own original
    CONTACT = 5  # as the camera's: something else is too near


class Drawn(IntEnum):
    """How a cut draws one thing of the scene."""

    MISSING = 0
    ITSELF = 1
    IN_GROUP = 2
    OPENED = 3
    NOT = 4


class SimplifyMode(IntEnum):
    """How triangles are saved."""

    FAST = 0
    BEST = 1
    CLUSTER = 2


class Channel(IntEnum):
    """Which of a texel's numbers counts."""

    COLOR = 0
    RED = 1
    GREEN = 2
    BLUE = 3
    ALPHA = 4
    LUMA = 5


class Extension(IntEnum):
    """What lies outside 0...1 of a picture."""

    REPEAT = 0
    EXTEND = 1
    CLIP = 2
    MIRROR = 3


class BakeOp(IntEnum):
    """What a step of a bake does with the results a, b, c of earlier ones."""

    CONSTANT = 0
    TEXEL = 1
    CHANNEL = 2
    LUMA = 3
    COMBINE = 4
    ADD = 5
    SUBTRACT = 6
    MULTIPLY = 7
    DIVIDE = 8
    POWER = 9
    MINIMUM = 10
    MAXIMUM = 11
    MIX = 12
    GREATER = 13
    ABSOLUTE = 14
    FLOOR = 15
    MODULO = 16
    RAMP = 17
    CURVES = 18
    TO_HSV = 19
    FROM_HSV = 20
    TO_SRGB = 21
    FROM_SRGB = 22


class Projection(IntEnum):
    """How texture coordinates are made from positions."""

    FLAT = 0
    BOX = 1
    SPHERE = 2
    TUBE = 3


class AlphaMode(IntEnum):
    OPAQUE = 0
    BLEND = 1
    CLIP = 2


class Antialias(IntEnum):
    OFF = 0
    FINAL = 1
    REFERENCE = 2


class LightKind(IntEnum):
    SUN = 0
    POINT = 1
    SPOT = 2
    AREA = 3


class Severity(IntEnum):
    INFO = 0
    WARNING = 1
    ERROR = 2
