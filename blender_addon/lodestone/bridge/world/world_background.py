# SPDX-License-Identifier: GPL-3.0-or-later
"""The world: one color, an image all around, or nodes drawn into an image; else its mean, named."""

import math
import os
from array import array
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import bpy
from mathutils import Vector

from ...core import exr_bytes, srgb
from ...core.native import lodestone_native as native
from ...core.problems import ERROR, INFO, WARNING, Problems
from ..datablock_ids import name_of
from ..nodes.image_means import ImageHeads, ImageMeans
from ..nodes.image_pixels import read_pixels
from ..nodes.node_values import NodeValues
from .drawn_sky import drawn_sky
from .sky_nodes import SkyNodes, Unknown
from .sky_texture import Sky, SkyToDraw, mean_of_sky

MOST_BACKGROUNDS = 16  # in one world
WIDTH, HEIGHT = 128, 64  # the size of the image that nodes are drawn into
_READ = {"PNG", "JPEG", "OPEN_EXR"}  # formats that the backend reads itself


@dataclass(frozen=True)
class World:
    """A world as native.Model.set_world wants it; `environment` is one of its pictures."""

    color: tuple[float, float, float]
    environment: int | None = None
    turn: tuple[float, ...] = (1, 0, 0, 0, 1, 0, 0, 0, 1)
    strength: tuple[float, float, float] = (1.0, 1.0, 1.0)


def extract(
    model: Any,
    world: Any | None,
    problems: Problems,
    images: ImageMeans | None = None,
    store: str = "",
) -> World:
    """The world of an evaluated scene; no world is black. Adds the environment's picture to the
    model. With ImageHeads only problems are looked for. `store`: the folder of levels, which keeps
    what takes long; "": none does."""
    if world is None:
        return World((0.0, 0.0, 0.0))
    if not world.use_nodes or world.node_tree is None:
        return World(tuple(world.color))
    return _Reader(model, world, problems, images or ImageMeans(), store).read()


class _Reader:
    def __init__(
        self, model: Any, world: Any, problems: Problems, means: ImageMeans, store: str
    ) -> None:
        self._model = model
        self._store = store
        self._world = world
        self._problems = problems
        self._means = means
        self._glance = isinstance(means, ImageHeads)
        self._images: dict[int, Any] = {}

    def read(self) -> World:
        tree = self._world.node_tree
        output = tree.get_output_node("CYCLES")
        if output is None or not output.inputs["Surface"].is_linked:
            return World((0.0, 0.0, 0.0))
        if output.inputs["Volume"].is_linked:
            self._note(WARNING, "volume", "its volume is left out")
        parts: list[Part] = []
        _parts(output.inputs["Surface"], (), set(), parts)
        if not parts:
            text = "drawn as its viewport color: its shader is not known"
            self._note(WARNING, "shader", text)
            return World(tuple(self._world.color))
        node = parts[0].node
        if len(parts) > 1 or parts[0].shares:
            found = self._drawn(parts, f'its first background, "{name_of(node)}", alone')
            if found is not None:
                return found
        if not any(node.inputs[name].is_linked for name in ("Color", "Strength")):
            return World(self._mean(node))
        return (
            self._image(node)
            or self._drawn([Part(node)], "one flat color")
            or World(self._mean(node))
        )

    # ---- An image as it is ----

    def _image(self, node: Any) -> World | None:
        """An environment texture right behind the color, turned or not, times a constant."""
        color, strength = node.inputs["Color"], node.inputs["Strength"]
        if strength.is_linked or not color.is_linked:
            return None
        texture = color.links[0].from_node
        if texture.type != "TEX_ENVIRONMENT" or texture.projection != "EQUIRECTANGULAR":
            return None
        if texture.image is None:
            self._note(ERROR, "image_missing", "its environment texture has no image")
            return None
        try:
            turn = _linear(SkyNodes(self._texel).direction(texture))
        except Unknown:
            return None
        index = self._picture(texture.image) if turn else None
        if index is None:
            return None
        return World((0.0, 0.0, 0.0), index, turn, (max(0.0, strength.default_value),) * 3)

    def _picture(self, image: Any) -> int | None:
        if self._glance:
            if self._means.mean(image) is None:
                self._note(ERROR, "image_missing", f'image "{name_of(image)}" cannot be read')
            return 0
        linear = image.colorspace_settings.name != "sRGB"
        given = image.source == "FILE" and not image.is_dirty and image.file_format in _READ
        try:
            if given and image.packed_file is not None:
                data = image.packed_file.data
                return self._model.add_picture(name_of(image), data=data, linear=linear)
            if given:
                path = bpy.path.abspath(image.filepath, library=image.library)
                if os.path.isfile(path):
                    return self._model.add_picture(name_of(image), path=path, linear=linear)
        except native.LodestoneError as error:
            if error.status not in {native.Status.BAD_FILE, native.Status.IO}:
                raise
        found = self._pixels(image)
        if found is None:
            self._note(ERROR, "image_missing", f'image "{name_of(image)}" cannot be read')
            return None
        width, height, pixels = found
        return self._model.add_picture(name_of(image), data=exr_bytes.encode(width, height, pixels))

    # ---- Nodes, looked at all around ----

    def _drawn(self, parts: list["Part"], otherwise: str) -> World | None:
        """The sum of its backgrounds, times their shares of mixtures. None, and what is drawn
        `otherwise` is named, when a node is not known."""
        nodes = SkyNodes(self._texel, self._sky)
        try:
            light = _sum([_followed(nodes, part) for part in parts])
        except Unknown as unknown:
            self._note(WARNING, "nodes", f"drawn as {otherwise}: {unknown} is not known")
            return None
        for code, text in nodes.approximated.items():
            self._note(WARNING, code, text)
        self._add_suns(nodes, light)
        if all(_constant(part) for part in parts):
            return World(_in_range(light(Vector((0.0, 0.0, 1.0)))))
        size = f"{WIDTH} x {HEIGHT}"
        self._note(INFO, "drawn", f"its nodes are drawn into an image of {size} pixels")
        if self._glance:
            return World((0.0, 0.0, 0.0), 0)
        pixels = array("f")
        for row in range(HEIGHT):
            height = math.pi * ((row + 0.5) / HEIGHT - 0.5)
            for column in range(WIDTH):
                turn = math.pi * (1.0 - 2.0 * (column + 0.5) / WIDTH)
                flat = math.cos(height)
                at = Vector((flat * math.cos(turn), flat * math.sin(turn), math.sin(height)))
                try:
                    pixels.extend(_in_range(light(at)))
                except (ArithmeticError, ValueError, TypeError):
                    pixels.extend((0.0, 0.0, 0.0))
        data = exr_bytes.encode(WIDTH, HEIGHT, pixels)
        return World((0.0, 0.0, 0.0), self._model.add_picture(name_of(self._world), data=data))

    def _add_suns(self, nodes: SkyNodes, light: "Light") -> None:
        """Adds the suns of skies as lights, as far as the nodes behind let their light through."""
        for sun in nodes.suns:
            nodes.lit_by = sun
            color = _in_range(light(Vector(sun.direction)))
            nodes.lit_by = None
            x, y, z = sun.direction
            given = native.Light(
                name=name_of(self._world),
                kind=native.LightKind.SUN,
                color=color,
                power=1.0,
                direction=(-x, -y, -z),
                angle=sun.angle,
            )
            self._model.add_light(given)

    def _sky(self, node: Any) -> Sky:
        if self._glance:
            return SkyToDraw(node)
        return drawn_sky(node, WIDTH, HEIGHT, self._store)

    def _texel(self, image: Any, u: float, v: float) -> Any | None:
        """The linear color of the pixel there; None when the image cannot be read."""
        if self._glance:
            return self._means.mean(image)
        key = image.as_pointer()
        if key not in self._images:
            self._images[key] = self._pixels(image)
        if self._images[key] is None:
            return None
        width, height, pixels = self._images[key]
        x = min(width - 1, max(0, int(u * width)))
        y = min(height - 1, max(0, int(v * height)))
        return tuple(pixels[3 * (y * width + x) : 3 * (y * width + x) + 3])

    def _pixels(self, image: Any) -> Any | None:
        """Width, height and linear RGB (array 'f', lowest row first) by Blender's own reader."""
        found = read_pixels(image)
        if found is None:
            return None
        width, height, pixels, channels, encoded, _ = found
        if encoded:
            table = srgb.DECODED
            pixels = array("f", (table[min(255, max(0, int(255.0 * p + 0.5)))] for p in pixels))
        wide = array("f", bytes(12 * width * height))
        for channel in range(3):
            wide[channel::3] = pixels[(channel if channels > 2 else 0) :: channels]
        return width, height, wide

    # ---- One color ----

    def _mean(self, node: Any) -> tuple[float, float, float]:
        def note(code: str, text: str) -> None:
            self._note(WARNING, code, f"drawn as one flat color ({text})")

        values = NodeValues(self._means, note)
        source = node.inputs["Color"]
        tint = None
        if source.is_linked:
            behind = source.links[0].from_node
            if behind.type == "TEX_SKY":
                note("sky", "the mean of a sky like it")
                tint = mean_of_sky(behind)
            elif behind.type == "TEX_ENVIRONMENT" and behind.image is not None:
                tint = self._means.mean(behind.image)
                if tint is not None:
                    note("texture_mean", "the mean of its environment texture")
        if tint is None:
            tint = values.color(source)
        strength = values.number(node.inputs["Strength"])
        return tuple(min(1e9, max(0.0, strength * c)) for c in tint)

    def _note(self, severity: str, code: str, text: str) -> None:
        name = name_of(self._world)
        self._problems.add(name, severity, f"world_{code}", f'World "{name}": {text}')


Light = Callable[[Vector], tuple[float, ...]]


@dataclass(frozen=True)
class Part:
    """A background (or emission) node; of a mixture it has the product of `shares`: (socket of a
    factor, whether it has the rest of it)."""

    node: Any
    shares: tuple[tuple[Any, bool], ...] = ()


def _parts(socket: Any, shares: tuple, above: set, found: list[Part]) -> None:
    """The backgrounds that feed this socket, the first one first. `above`: names of the nodes on
    the way here."""
    link = next((link for link in socket.links if link.is_valid and not link.is_muted), None)
    if link is None or name_of(link.from_node) in above or len(found) >= MOST_BACKGROUNDS:
        return
    node = link.from_node
    above = {*above, name_of(node)}
    if node.type in {"BACKGROUND", "EMISSION"}:
        found.append(Part(node, shares))
    elif node.type == "MIX_SHADER":
        factor, first, second = node.inputs[0], node.inputs[1], node.inputs[2]
        _parts(first, (*shares, (factor, True)), above, found)
        _parts(second, (*shares, (factor, False)), above, found)
    else:
        for inner in node.inputs:
            if inner.type == "SHADER" or node.type == "REROUTE":
                _parts(inner, shares, above, found)


def _followed(nodes: SkyNodes, part: Part) -> Light:
    """The light of one background by direction. Raises Unknown."""
    color = nodes.color(part.node.inputs["Color"])
    factors = [(nodes.number(part.node.inputs["Strength"]), False, False)]
    factors += [(nodes.number(socket), True, rest) for socket, rest in part.shares]

    def light(at: Vector) -> tuple[float, ...]:
        power = 1.0
        for number, share, rest in factors:
            value = number(at)
            if share:
                value = min(1.0, max(0.0, value))
            power *= 1.0 - value if rest else value
        return tuple(power * value for value in color(at))

    return light


def _constant(part: Part) -> bool:
    sockets = [part.node.inputs["Color"], part.node.inputs["Strength"]]
    return not any(socket.is_linked for socket in [*sockets, *(s for s, _ in part.shares)])


def _sum(lights: list[Light]) -> Light:
    return lambda at: tuple(sum(values) for values in zip(*(light(at) for light in lights)))


def _in_range(color: Any) -> tuple[float, float, float]:
    red, green, blue = (min(1e9, max(0.0, v)) if v == v else 0.0 for v in color)
    return (red, green, blue)


def _linear(function: Any) -> tuple[float, ...] | None:
    """The row-major rotation (or mirror) that a function of directions is; None for others."""
    columns = [Vector(function(Vector(axis))) for axis in ((1, 0, 0), (0, 1, 0), (0, 0, 1))]
    size = columns[0].length
    if size < 1e-6:
        return None
    for test in ((0.0, 0.0, 0.0), (0.3, -0.5, 0.8), (-0.7, 0.2, -0.4)):
        expected = sum((c * t for c, t in zip(columns, test)), Vector((0.0, 0.0, 0.0)))
        if (Vector(function(Vector(test))) - expected).length > 1e-5 * size:
            return None
    for one, other in ((0, 1), (1, 2), (2, 0)):
        if abs(columns[one].dot(columns[other])) > 1e-5 * size * size:
            return None
        if abs(columns[one].length - columns[other].length) > 1e-5 * size:
            return None
    return tuple(columns[column][row] / size for row in range(3) for column in range(3))
