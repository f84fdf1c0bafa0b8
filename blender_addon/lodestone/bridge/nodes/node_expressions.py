# SPDX-License-Identifier: GPL-3.0-or-later
"""The inputs of node sockets as expressions of images' texels and of constants.

A value that cannot be said is named and stands as a constant for its mean: that of the node's own
colors, else the value of the input it feeds.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ...core import object_random
from ...core.expression import node_math
from ...core.expression import color_expression as e
from ...core.expression.color_expression import Color, Expression, Op
from ...core.native import lodestone_native as native
from ...core.problems import ERROR, INFO, WARNING
from ..datablock_ids import name_of
from . import node_graph, node_tables
from .image_sources import MISSING, Source, missing, source_of
from .texture_coordinates import Coordinates, Unknown, of_image_node

Note = Callable[[str, str, str], None]  # severity, code, words
_MAX_DEPTH = 48
_EXTENSIONS = {
    "REPEAT": native.Extension.REPEAT,
    "EXTEND": native.Extension.EXTEND,
    "CLIP": native.Extension.CLIP,
    "MIRROR": native.Extension.MIRROR,
}
_NO_COORDINATES = Coordinates("NONE")


@dataclass(frozen=True)
class Sample:
    """A leaf: an image looked up somewhere. Its texels are linear color and alpha, straight."""

    source: Source
    coordinates: Coordinates = _NO_COORDINATES
    to_picture: tuple[float, ...] = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0)
    extension: int = native.Extension.REPEAT
    closest: bool = False


@dataclass(frozen=True)
class VertexColor:
    """A leaf: the mesh's color attribute of that name ("": the one active for rendering)."""

    name: str


@dataclass(frozen=True)
class Setting:
    """The surroundings of a material that its values may depend on."""

    frame: int = 1
    object_color: tuple[float, ...] | None = None  # RGBA; None: of no particular object
    material_index: int = 0
    object_random: float = object_random.MEAN


class NodeExpressions:
    """`pictures` is a Pictures or NoPictures; `note` is told about all that is not exact."""

    def __init__(self, pictures: Any, note: Note, setting: Setting = Setting()) -> None:
        self.pictures = pictures
        self._note = note
        self._setting = setting
        self._found: dict[tuple, Expression | None] = {}
        self.depends_on_color = False
        self.depends_on_random = False

    def color(self, socket: Any, groups: tuple = (), depth: int = 0) -> Expression:
        """The socket's linear color; `groups` are the group nodes around it, outermost first."""
        return self._fed(socket, groups, depth)[0]

    def number(self, socket: Any, groups: tuple = (), depth: int = 0) -> Expression:
        """The same as a number, turned into one as Blender does it."""
        found, kind = self._fed(socket, groups, depth)
        if kind == "VALUE":
            return found
        if kind == "VECTOR":
            parts = [e.channel(found, k) for k in range(3)]
            return e.multiply(e.add(e.add(parts[0], parts[1]), parts[2]), e.number(1.0 / 3.0))
        return e.luma(found)

    def _fed(self, socket: Any, groups: tuple, depth: int) -> tuple[Expression, str]:
        """The expression that feeds a socket, and the type of what it comes from."""
        found = node_graph.feed(socket, groups)
        if found.node is None:
            return own_value(found.socket), found.socket.type
        key = (found.socket.as_pointer(), tuple(g.as_pointer() for g in found.groups))
        if key not in self._found:
            self._found[key] = None  # a second time inside itself
            self._found[key] = self._output(found, depth + 1)
        value = self._found[key]
        if value is None:
            label = found.node.bl_label
            self._note(WARNING, "node_color", f"{label} is left out: its input's own value counts")
            return e.constant(own_value(socket).value, False), socket.type
        return value, found.socket.type

    def _output(self, found: node_graph.Feed, depth: int) -> Expression | None:
        if depth > _MAX_DEPTH:
            self._note(WARNING, "node_depth", "nests its nodes too deeply; the rest is left out")
            return None
        kind = found.node.type
        handler = _HANDLERS.get(kind)
        if handler is not None:
            return handler(self, found.node, found.socket, found.groups, depth)
        mean = node_tables.PROCEDURAL.get(kind)
        if mean is not None and found.socket.type != "VECTOR":
            label = found.node.bl_label
            self._note(WARNING, "node_color", f"{label} is drawn as its mean")
            return e.number(mean, False)
        return self._mean_of_inputs(found, depth)

    # ---- Images ----

    def _image(self, node: Any, output: Any, groups: tuple, depth: int) -> Expression:
        sample = self._sample(node, groups)
        if sample.source.kind == MISSING or self.pictures.index(sample.source) is None:
            if sample.source.kind != MISSING:
                name = sample.source.name
                text = f'image "{name}" cannot be read; drawn in magenta'
                self._note(ERROR, "image_missing", text)
            return e.ONE if output.name == "Alpha" else e.constant((1.0, 0.0, 1.0))
        source = sample.source
        if output.name == "Alpha":
            return e.alpha(sample) if source.has_alpha else e.ONE
        color = e.texel(sample)
        if not source.has_alpha or source.packed_channels or source.data:
            return color
        if self.pictures.mean(source)[3] >= 1.0 - 1e-9:
            return color
        used = node.outputs["Alpha"].is_linked
        if used == (not source.associated):
            return color
        # As Cycles: where nobody asks for the alpha a color is times alpha, as the file has it
        stored = color if source.linear else e.apply(Op.TO_SRGB, color)
        if used:
            stored = e.apply(Op.MINIMUM, e.apply(Op.DIVIDE, stored, e.alpha(sample)), e.ONE)
        else:
            stored = e.multiply(stored, e.alpha(sample))
        return stored if source.linear else e.apply(Op.FROM_SRGB, stored)

    def _sample(self, node: Any, groups: tuple) -> Sample:
        if node.image is None:
            self._note(ERROR, "image_missing", "an image texture has no image; drawn in magenta")
            return Sample(missing(""))
        source = source_of(node.image, node.image_user, self._setting.frame, self._note)
        extension = _EXTENSIONS.get(node.extension, native.Extension.REPEAT)
        closest = node.interpolation == "Closest"
        if node.interpolation in {"Cubic", "Smart"}:
            self._note(INFO, "interpolation", f'image "{source.name}" is interpolated linearly')
        try:
            mapped = of_image_node(node, groups)
        except Unknown as unknown:
            text = f'image "{source.name}" is drawn as its mean: {unknown}'
            self._note(WARNING, "texture_coordinates", text)
            return Sample(source)
        if node.projection == "BOX" and node.projection_blend > 0.0:
            self._note(INFO, "box_blend", "box projection is drawn without blending")
        return Sample(source, mapped.coordinates, mapped.to_picture, extension, closest)

    # ---- Constants and inputs from elsewhere ----

    def _rgb(self, node: Any, output: Any, groups: tuple, depth: int) -> Expression:
        return own_value(node.outputs[0])

    def _vertex_color(self, node: Any, output: Any, groups: tuple, depth: int) -> Expression:
        leaf = VertexColor(name_of(node, "layer_name"))
        return e.alpha(leaf) if output.name == "Alpha" else e.texel(leaf)

    def _attribute(self, node: Any, output: Any, groups: tuple, depth: int) -> Expression | None:
        name = name_of(node, "attribute_name")
        if node.attribute_type == "GEOMETRY":
            leaf = VertexColor(name)
            value = e.alpha(leaf) if output.name == "Alpha" else e.texel(leaf)
            return e.luma(value) if output.name == "Fac" else value
        if name == "color" and output.name in {"Color", "Vector", "Alpha"}:
            return self._object_color(output.name == "Alpha")
        text = f'attribute "{name}" of the {node.attribute_type.lower()} is left out'
        self._note(WARNING, "attribute", text)
        return e.number(0.0, False)

    def _object_info(self, node: Any, output: Any, groups: tuple, depth: int) -> Expression:
        if output.name in {"Color", "Alpha"}:
            return self._object_color(output.name == "Alpha")
        if output.name == "Material Index":
            return e.number(float(self._setting.material_index))
        if output.name == "Random":
            self.depends_on_random = True
            grades = object_random.GRADES
            text = f"Object Info's Random has {grades} values among objects of one mesh"
            self._note(INFO, "object_random", text)
            return e.number(self._setting.object_random)
        text = f"Object Info's {output.name} is the same for all objects (0)"
        self._note(WARNING, "object_info", text)
        return e.number(0.0, False)

    def _object_color(self, of_alpha: bool) -> Expression:
        self.depends_on_color = True
        color = self._setting.object_color or (1.0, 1.0, 1.0, 1.0)
        return e.number(color[3]) if of_alpha else e.constant(color[:3])

    def _light_path(self, node: Any, output: Any, groups: tuple, depth: int) -> Expression:
        self._note(INFO, "light_path", "Light Path: all rays see what the camera sees")
        return e.ONE if output.name == "Is Camera Ray" else e.ZERO

    def _fresnel(self, node: Any, output: Any, groups: tuple, depth: int) -> Expression:
        """The mean of a Fresnel or Layer Weight node over the directions a surface is seen from."""
        self._note(WARNING, "fresnel", f"{node.bl_label} is drawn as its mean")
        if node.type == "FRESNEL":
            ior = max(1.0, mean_of(self.number(node.inputs["IOR"], groups, depth))[0])
        else:
            weight = mean_of(self.number(node.inputs["Blend"], groups, depth))[0]
            if output.name == "Facing":
                return e.number(node_tables.facing(weight), False)
            ior = 1.0 / max(1e-3, 1.0 - min(weight, 0.999))
        normal = ((ior - 1.0) / (ior + 1.0)) ** 2
        return e.number(normal + (1.0 - normal) / 21.0, False)

    def _geometry(self, node: Any, output: Any, groups: tuple, depth: int) -> Expression | None:
        if output.name == "Backfacing":
            self._note(INFO, "backfacing", "back sides are drawn as front sides")
            return e.ZERO
        return self._named_mean(node, output)

    def _named_mean(self, node: Any, output: Any) -> Expression:
        self._note(WARNING, "node_color", f"{node.bl_label} ({output.name}) is drawn as its mean")
        return e.number(0.5, False)

    def _blackbody(self, node: Any, output: Any, groups: tuple, depth: int) -> Expression:
        given = self.number(node.inputs["Temperature"], groups, depth)
        return e.constant(node_tables.blackbody(mean_of(given)[0]), given.constant and given.exact)

    # ---- Functions ----

    def _mix(self, node: Any, output: Any, groups: tuple, depth: int) -> Expression | None:
        enabled = [socket for socket in node.inputs if socket.enabled]
        if len(enabled) != 3:
            return None
        share, a, b = enabled
        number = node.type == "MIX" and node.data_type == "FLOAT"
        get = self.number if number else self.color
        first, second = get(a, groups, depth), get(b, groups, depth)
        part = (self.number if share.type == "VALUE" else self.color)(share, groups, depth)
        if node.type == "MIX_RGB" or node.clamp_factor:
            part = e.clamp(part)
        kind = node.blend_type if node.type == "MIX_RGB" or node.data_type == "RGBA" else "MIX"
        result = node_math.blend(kind, first, second, part)
        if result is None:
            words = f"mixing by {kind.lower().replace('_', ' ')} is drawn as plain mixing"
            self._note(WARNING, "node_color", words)
            result = e.mix(first, second, part)
        clamped = node.use_clamp if node.type == "MIX_RGB" else node.clamp_result
        return e.clamp(result) if clamped and not number else result

    def _math(self, node: Any, output: Any, groups: tuple, depth: int) -> Expression | None:
        args = [self.number(s, groups, depth) for s in node.inputs if s.enabled]
        result = node_math.maths(node.operation, args)
        if result is None:
            words = f"Math ({node.operation.lower()}) is drawn as its first value"
            self._note(WARNING, "node_color", words)
            result = args[0]
        return e.clamp(result) if node.use_clamp else result

    def _vector_math(self, node: Any, output: Any, groups: tuple, depth: int) -> Expression | None:
        enabled = [s for s in node.inputs if s.enabled]
        args = [self.color(s, groups, depth) for s in enabled]
        kind = node.operation
        if kind == "SCALE":
            return e.multiply(args[0], self.number(enabled[-1], groups, depth))
        if kind == "DOT_PRODUCT":
            product = e.multiply(args[0], args[1])
            parts = [e.channel(product, k) for k in range(3)]
            return e.add(e.add(parts[0], parts[1]), parts[2])
        known = {"ADD", "SUBTRACT", "MULTIPLY", "DIVIDE", "MULTIPLY_ADD", "ABSOLUTE", "MINIMUM"}
        if kind in known | {"MAXIMUM", "FLOOR", "CEIL", "MODULO", "SNAP", "WRAP"}:
            return node_math.maths(kind, args)
        return None

    def _map_range(self, node: Any, output: Any, groups: tuple, depth: int) -> Expression | None:
        kind = node.interpolation_type
        if getattr(node, "data_type", "FLOAT") != "FLOAT" or kind == "STEPPED":
            return None
        value, *limits = [self.number(s, groups, depth) for s in node.inputs if s.enabled]
        low, high, to_low, to_high = limits[:4]
        if kind == "LINEAR":
            result = node_math.mapped(value, low, high, to_low, to_high)
            if not node.clamp:
                return result
            if to_low.constant and to_high.constant:
                ends = sorted((to_low.value[0], to_high.value[0]))
                return e.clamp(result, *ends)
        part = e.clamp(node_math.mapped(value, low, high, e.ZERO, e.ONE))
        if kind != "LINEAR":
            part = node_math.smooth(kind, part)
        return e.mix(to_low, to_high, part)

    def _clamp(self, node: Any, output: Any, groups: tuple, depth: int) -> Expression:
        value, low, high = [self.number(s, groups, depth) for s in node.inputs]
        if low.constant and high.constant:
            ends = (low.value[0], high.value[0])
            if node.clamp_type == "RANGE":
                ends = (min(ends), max(ends))
            return e.clamp(value, *ends)
        return e.apply(Op.MINIMUM, e.apply(Op.MAXIMUM, value, low), high)

    def _invert(self, node: Any, output: Any, groups: tuple, depth: int) -> Expression:
        share = self.number(node.inputs[0], groups, depth)
        color = self.color(node.inputs[1], groups, depth)
        return e.mix(color, e.subtract(e.ONE, color), share)

    def _gamma(self, node: Any, output: Any, groups: tuple, depth: int) -> Expression:
        color = self.color(node.inputs[0], groups, depth)
        return e.apply(Op.POWER, color, self.number(node.inputs[1], groups, depth))

    def _contrast(self, node: Any, output: Any, groups: tuple, depth: int) -> Expression:
        color = self.color(node.inputs[0], groups, depth)
        bright, contrast = (self.number(node.inputs[k], groups, depth) for k in (1, 2))
        shift = e.subtract(bright, e.multiply(contrast, e.number(0.5)))
        result = e.add(e.multiply(color, e.add(e.ONE, contrast)), shift)
        return result if e.bounds(result)[0] >= 0.0 else e.apply(Op.MAXIMUM, result, e.ZERO)

    def _hue(self, node: Any, output: Any, groups: tuple, depth: int) -> Expression:
        hue, saturation, value, share = (
            self.number(socket, groups, depth) for socket in node.inputs[:4]
        )
        color = self.color(node.inputs[4], groups, depth)
        if all(v.constant and v.value[0] == n for v, n in ((hue, 0.5), (saturation, 1.0))):
            return e.mix(color, e.multiply(color, value), share)
        return e.mix(color, node_math.hue_saturation(color, hue, saturation, value), share)

    def _ramp(self, node: Any, output: Any, groups: tuple, depth: int) -> Expression:
        value = self.number(node.inputs[0], groups, depth)
        table = node_tables.ramp(node.color_ramp, output.name == "Alpha")
        return e.ramp(value, table)

    def _curves(self, node: Any, output: Any, groups: tuple, depth: int) -> Expression:
        color = self.color(node.inputs[1], groups, depth)
        share = self.number(node.inputs[0], groups, depth)
        table = node_tables.curves(node.mapping, 1 if node.type == "CURVE_FLOAT" else 3)
        return e.mix(color, e.curves(color, table), share)

    def _to_gray(self, node: Any, output: Any, groups: tuple, depth: int) -> Expression:
        return e.luma(self.color(node.inputs[0], groups, depth))

    def _separate(self, node: Any, output: Any, groups: tuple, depth: int) -> Expression | None:
        color = self.color(node.inputs[0], groups, depth)
        mode = "HSV" if node.type == "SEPHSV" else getattr(node, "mode", "RGB")
        if mode == "HSL":
            return None
        if mode == "HSV":
            color = e.apply(Op.TO_HSV, color)
        index = [s.identifier for s in node.outputs].index(output.identifier)
        return e.channel(color, index)

    def _combine(self, node: Any, output: Any, groups: tuple, depth: int) -> Expression | None:
        parts = [self.number(socket, groups, depth) for socket in node.inputs]
        mode = "HSV" if node.type == "COMBHSV" else getattr(node, "mode", "RGB")
        if mode == "HSL":
            return None
        color = e.apply(Op.COMBINE, *parts)
        return e.apply(Op.FROM_HSV, color) if mode == "HSV" else color

    def _mean_of_inputs(self, found: node_graph.Feed, depth: int) -> Expression | None:
        """A node we do not know: the mean of the colors that go in."""
        node = found.node
        sockets = [s for s in node.inputs if s.type == "RGBA" and s.enabled]
        if not sockets:
            sockets = [s for s in node.inputs if s.is_linked and s.type == "VALUE" and s.enabled]
        if not sockets:
            return None
        self._note(WARNING, "node_color", f"{node.bl_label} is drawn as the mean of its colors")
        total = e.ZERO
        for socket in sockets:
            total = e.add(total, self.color(socket, found.groups, depth))
        mean = e.multiply(total, e.number(1.0 / len(sockets), False))
        return mean if mean.constant else e.add(mean, e.number(0.0, False))


_HANDLERS: dict[str, Callable[..., Expression | None]] = {
    "TEX_IMAGE": NodeExpressions._image,
    "RGB": NodeExpressions._rgb,
    "VALUE": NodeExpressions._rgb,
    "VERTEX_COLOR": NodeExpressions._vertex_color,
    "ATTRIBUTE": NodeExpressions._attribute,
    "OBJECT_INFO": NodeExpressions._object_info,
    "LIGHT_PATH": NodeExpressions._light_path,
    "FRESNEL": NodeExpressions._fresnel,
    "LAYER_WEIGHT": NodeExpressions._fresnel,
    "NEW_GEOMETRY": NodeExpressions._geometry,
    "BLACKBODY": NodeExpressions._blackbody,
    "MIX_RGB": NodeExpressions._mix,
    "MIX": NodeExpressions._mix,
    "MATH": NodeExpressions._math,
    "VECT_MATH": NodeExpressions._vector_math,
    "MAP_RANGE": NodeExpressions._map_range,
    "CLAMP": NodeExpressions._clamp,
    "INVERT": NodeExpressions._invert,
    "GAMMA": NodeExpressions._gamma,
    "BRIGHTCONTRAST": NodeExpressions._contrast,
    "HUE_SAT": NodeExpressions._hue,
    "VALTORGB": NodeExpressions._ramp,
    "CURVE_RGB": NodeExpressions._curves,
    "CURVE_FLOAT": NodeExpressions._curves,
    "RGBTOBW": NodeExpressions._to_gray,
    "SEPARATE_COLOR": NodeExpressions._separate,
    "SEPRGB": NodeExpressions._separate,
    "SEPHSV": NodeExpressions._separate,
    "SEPXYZ": NodeExpressions._separate,
    "COMBINE_COLOR": NodeExpressions._combine,
    "COMBRGB": NodeExpressions._combine,
    "COMBHSV": NodeExpressions._combine,
    "COMBXYZ": NodeExpressions._combine,
}


def own_value(socket: Any) -> Expression:
    """A socket's own value."""
    value = getattr(socket, "default_value", 0.0)
    if isinstance(value, (int, float)):
        return e.number(float(value))
    try:
        return e.constant((float(value[0]), float(value[1]), float(value[2])))
    except (TypeError, IndexError):
        return e.ZERO


def mean_of(value: Expression, pictures: Any = None) -> Color:
    """A color that stands for all of it: images by their means, vertex colors by gray."""

    def mean(leaf: Any, of_alpha: bool) -> Expression:
        texel = pictures.mean(leaf.source) if pictures and isinstance(leaf, Sample) else None
        if texel is None:
            return e.number(1.0 if of_alpha else 0.5, False)
        return e.number(texel[3], False) if of_alpha else e.constant(texel[:3], False)

    return e.replaced(value, mean).value
