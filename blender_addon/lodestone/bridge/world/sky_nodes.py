# SPDX-License-Identifier: GPL-3.0-or-later
"""A world's nodes as functions of the direction one looks in."""

import math
from collections.abc import Callable
from typing import Any

from mathutils import Euler, Matrix, Vector

from ..datablock_ids import name_of
from .sky_texture import MeanSky, Sky, SkySun, place_all_around

Value = Any  # a float for numbers, a tuple of three for colors and vectors
Function = Callable[[Vector], Value]
_MAX_DEPTH = 32
_LUMA = (0.2126, 0.7152, 0.0722)


class Unknown(Exception):
    """A node that is not translated; the text is its name."""


class SkyNodes:
    """A world's nodes as functions. `texel(image, u, v)` gives the linear color of an image there,
    or None; `sky(node)` the sky of a sky texture. `approximated`: sentences by code on what of the
    nodes was followed only nearly. `suns`: those of sky textures; while one is `lit_by`, its sky
    has the sun's light in place of its own."""

    def __init__(
        self,
        texel: Callable[[Any, float, float], Value | None],
        sky: Callable[[Any], Sky] = MeanSky,
    ) -> None:
        self._texel, self._sky = texel, sky
        self.approximated: dict[str, str] = {}
        self.suns: list[SkySun] = []
        self.lit_by: SkySun | None = None
        self._depth = 0

    def color(self, socket: Any) -> Function:
        """Raises Unknown."""
        inner = self.value(socket)
        return lambda d: _as_color(inner(d))

    def number(self, socket: Any) -> Function:
        inner = self.value(socket)
        return lambda d: _as_number(inner(d))

    def value(self, socket: Any) -> Function:
        link = next((ln for ln in socket.links if ln.is_valid and not ln.is_muted), None)
        if link is None:
            constant = _default(socket)
            return lambda d: constant
        node = link.from_node
        make = getattr(self, f"_{node.type.lower()}", None)
        if make is None or self._depth > _MAX_DEPTH:
            raise Unknown(node.bl_label)
        self._depth += 1
        try:
            return make(node, link.from_socket)
        finally:
            self._depth -= 1

    # ---- Where ----

    def direction(self, node: Any) -> Function:
        """The vector a texture node looks at; without a link, the direction itself."""
        socket = node.inputs["Vector"]
        return self.color(socket) if socket.is_linked else tuple

    def _tex_coord(self, node: Any, socket: Any) -> Function:
        if socket.name not in {"Generated", "Object"} or node.object is not None:
            raise Unknown(f"{node.bl_label} ({socket.name})")
        return tuple

    def _mapping(self, node: Any, socket: Any) -> Function:
        vector = self.color(node.inputs["Vector"])
        sockets = ("Location", "Rotation", "Scale")
        given = {name: node.inputs[name] for name in sockets if name in node.inputs}
        if any(item.is_linked for item in given.values()):
            raise Unknown(node.bl_label)
        place, turn, scale = (
            Vector(given[name].default_value) if name in given else Vector((0.0, 0.0, 0.0))
            for name in sockets
        )
        turned = Euler(turn).to_matrix()
        if node.vector_type == "NORMAL":
            scale = Vector([1.0 / s if s else 0.0 for s in scale])
        matrix = turned @ Matrix.Diagonal(scale)
        if node.vector_type == "TEXTURE":
            inverse = matrix.inverted_safe()
            return lambda d: tuple(inverse @ (Vector(vector(d)) - place))
        if node.vector_type == "POINT":
            return lambda d: tuple(matrix @ Vector(vector(d)) + place)
        if node.vector_type == "NORMAL":
            return lambda d: tuple((matrix @ Vector(vector(d))).normalized())
        return lambda d: tuple(matrix @ Vector(vector(d)))

    # ---- Textures ----

    def _tex_environment(self, node: Any, socket: Any) -> Function:
        image = node.image
        if image is None or node.projection != "EQUIRECTANGULAR":
            raise Unknown(node.bl_label)
        vector = self.direction(node)
        if self._texel(image, 0.5, 0.5) is None:
            raise Unknown(f'image "{name_of(image)}"')

        def sample(d: Vector) -> Value:
            return self._texel(image, *place_all_around(*vector(d)))

        return sample

    def _tex_gradient(self, node: Any, socket: Any) -> Function:
        vector, kind = self.direction(node), node.gradient_type

        def sample(d: Vector) -> Value:
            share = min(1.0, max(0.0, _GRADIENTS[kind](*vector(d))))
            return share if socket.type == "VALUE" else (share,) * 3

        return sample

    def _valtorgb(self, node: Any, socket: Any) -> Function:
        share = self.number(node.inputs["Fac"])
        steps = [tuple(node.color_ramp.evaluate(i / 256)) for i in range(257)]

        def sample(d: Vector) -> Value:
            at = min(1.0, max(0.0, share(d))) * 256
            low = min(255, int(at))
            part = at - low
            if node.color_ramp.interpolation == "CONSTANT":
                part = 0.0
            color = [a + part * (b - a) for a, b in zip(steps[low], steps[low + 1])]
            return color[3] if socket.name == "Alpha" else tuple(color[:3])

        return sample

    def _tex_sky(self, node: Any, socket: Any) -> Function:
        vector, sky = self.direction(node), self._sky(node)
        if not sky.drawn:
            self.approximated["sky"] = "its sky is drawn in one color, the mean of a sky like it"
        sun = sky.sun
        if sun is not None and node.inputs["Vector"].is_linked:
            self.approximated["sky_sun"] = "the sun of its sky is left out"
            sun = None
        if sun is not None:
            self.suns.append(sun)

        def sample(d: Vector) -> Value:
            if sun is not None and self.lit_by is sun:
                return sun.light
            return sky.color(*vector(d))

        return sample

    def _light_path(self, node: Any, socket: Any) -> Function:
        if socket.name != "Is Camera Ray":
            raise Unknown(f"{node.bl_label} ({socket.name})")
        self.approximated["camera_rays"] = "drawn as it lights: the camera sees it no different"
        return lambda d: 0.0

    # ---- Colors and numbers ----

    def _rgb(self, node: Any, socket: Any) -> Function:
        color = tuple(node.outputs[0].default_value[:3])
        return lambda d: color

    def _value(self, node: Any, socket: Any) -> Function:
        number = float(node.outputs[0].default_value)
        return lambda d: number

    def _reroute(self, node: Any, socket: Any) -> Function:
        return self.value(node.inputs[0])

    def _separate(self, node: Any, socket: Any) -> Function:
        if getattr(node, "mode", "RGB") != "RGB":
            raise Unknown(node.bl_label)
        color = self.color(node.inputs[0])
        place = [name_of(item) for item in node.outputs].index(socket.name)
        return lambda d: color(d)[place]

    _sepxyz = _seprgb = _separate_color = _separate

    def _combine(self, node: Any, socket: Any) -> Function:
        if getattr(node, "mode", "RGB") != "RGB":
            raise Unknown(node.bl_label)
        parts = [self.number(item) for item in node.inputs[:3]]
        return lambda d: tuple(part(d) for part in parts)

    _combxyz = _combrgb = _combine_color = _combine

    def _mix_rgb(self, node: Any, socket: Any) -> Function:
        share = self.number(node.inputs["Fac"])
        return self._mixed(node, share, node.inputs["Color1"], node.inputs["Color2"])

    def _mix(self, node: Any, socket: Any) -> Function:
        enabled = [item for item in node.inputs if item.enabled]
        colors = [item for item in enabled if item.type == "RGBA"]
        if node.data_type != "RGBA" or len(colors) != 2:
            raise Unknown(node.bl_label)
        share = self.number(next(item for item in enabled if item.type != "RGBA"))
        return self._mixed(node, share, *colors)

    def _mixed(self, node: Any, share: Function, first: Any, second: Any) -> Function:
        blend = _BLENDS.get(node.blend_type)
        if blend is None:
            raise Unknown(f"{node.bl_label} ({node.blend_type.lower()})")
        a, b = self.color(first), self.color(second)

        def sample(d: Vector) -> Value:
            part = min(1.0, max(0.0, share(d)))
            return tuple(x + part * (blend(x, y) - x) for x, y in zip(a(d), b(d)))

        return sample

    def _gamma(self, node: Any, socket: Any) -> Function:
        color, power = self.color(node.inputs["Color"]), self.number(node.inputs["Gamma"])
        return lambda d: tuple(max(0.0, c) ** power(d) for c in color(d))

    def _invert(self, node: Any, socket: Any) -> Function:
        color, share = self.color(node.inputs["Color"]), self.number(node.inputs["Fac"])
        return lambda d: tuple(c + share(d) * (1.0 - 2.0 * c) for c in color(d))

    def _clamp(self, node: Any, socket: Any) -> Function:
        number, low, high = (self.number(node.inputs[name]) for name in ("Value", "Min", "Max"))
        return lambda d: min(high(d), max(low(d), number(d)))

    def _map_range(self, node: Any, socket: Any) -> Function:
        if node.interpolation_type != "LINEAR" or getattr(node, "data_type", "FLOAT") != "FLOAT":
            raise Unknown(node.bl_label)
        names = ("Value", "From Min", "From Max", "To Min", "To Max")
        number, from_low, from_high, low, high = (self.number(node.inputs[n]) for n in names)

        def sample(d: Vector) -> Value:
            width = from_high(d) - from_low(d)
            share = (number(d) - from_low(d)) / width if width else 0.0
            share = min(1.0, max(0.0, share)) if node.clamp else share
            return low(d) + share * (high(d) - low(d))

        return sample

    def _math(self, node: Any, socket: Any) -> Function:
        operation = _OPERATIONS.get(node.operation)
        if operation is None:
            raise Unknown(f"{node.bl_label} ({node.operation.lower()})")
        a, b = self.number(node.inputs[0]), self.number(node.inputs[1])
        if not node.use_clamp:
            return lambda d: operation(a(d), b(d))
        return lambda d: min(1.0, max(0.0, operation(a(d), b(d))))

    def _vect_math(self, node: Any, socket: Any) -> Function:
        kind = node.operation
        a = self.color(node.inputs[0])
        if kind == "NORMALIZE":
            return lambda d: tuple(Vector(a(d)).normalized())
        if kind == "SCALE":
            scale = self.number(node.inputs["Scale"])
            return lambda d: tuple(scale(d) * c for c in a(d))
        b, operation = self.color(node.inputs[1]), _OPERATIONS.get(kind)
        if kind not in {"ADD", "SUBTRACT", "MULTIPLY", "DIVIDE", "MINIMUM", "MAXIMUM"}:
            raise Unknown(f"{node.bl_label} ({kind.lower()})")
        return lambda d: tuple(operation(x, y) for x, y in zip(a(d), b(d)))


_GRADIENTS = {
    "LINEAR": lambda x, y, z: x,
    "QUADRATIC": lambda x, y, z: max(x, 0.0) ** 2,
    "EASING": lambda x, y, z: _ease(min(1.0, max(0.0, x))),
    "DIAGONAL": lambda x, y, z: (x + y) / 2.0,
    "RADIAL": lambda x, y, z: math.atan2(y, x) / (2.0 * math.pi) + 0.5,
    "SPHERICAL": lambda x, y, z: 0.999999 - math.sqrt(x * x + y * y + z * z),
    "QUADRATIC_SPHERE": lambda x, y, z: max(0.0, 0.999999 - math.sqrt(x * x + y * y + z * z)) ** 2,
}
_BLENDS = {
    "MIX": lambda x, y: y,
    "MULTIPLY": lambda x, y: x * y,
    "ADD": lambda x, y: x + y,
    "SUBTRACT": lambda x, y: x - y,
    "SCREEN": lambda x, y: 1.0 - (1.0 - x) * (1.0 - y),
    "DARKEN": min,
    "LIGHTEN": max,
}
_OPERATIONS = {
    "ADD": lambda x, y: x + y,
    "SUBTRACT": lambda x, y: x - y,
    "MULTIPLY": lambda x, y: x * y,
    "DIVIDE": lambda x, y: x / y if y else 0.0,
    "POWER": lambda x, y: x**y if x > 0.0 or y == int(y) and x else 0.0,
    "MINIMUM": min,
    "MAXIMUM": max,
    "LESS_THAN": lambda x, y: float(x < y),
    "GREATER_THAN": lambda x, y: float(x > y),
    "ABSOLUTE": lambda x, y: abs(x),
    "SQRT": lambda x, y: math.sqrt(max(0.0, x)),
    "SINE": lambda x, y: math.sin(x),
    "COSINE": lambda x, y: math.cos(x),
    "ARCSINE": lambda x, y: math.asin(x) if -1.0 <= x <= 1.0 else 0.0,
    "ARCCOSINE": lambda x, y: math.acos(x) if -1.0 <= x <= 1.0 else 0.0,
}


def _ease(x: float) -> float:
    return x * x * (3.0 - 2.0 * x)


def _default(socket: Any) -> Value:
    value = getattr(socket, "default_value", 0.0)
    if isinstance(value, (int, float)):
        return float(value)
    return tuple(float(part) for part in value[:3])


def _as_color(value: Value) -> Value:
    return (value,) * 3 if isinstance(value, float) else value


def _as_number(value: Value) -> float:
    if isinstance(value, float):
        return value
    return sum(weight * part for weight, part in zip(_LUMA, value))
