# SPDX-License-Identifier: GPL-3.0-or-later
"""Looks: materials in the backend's terms, before their pictures are added to a model."""

from dataclasses import dataclass, field
from typing import Any, NamedTuple

from ...core.expression.color_expression import Color
from ...core.native import lodestone_native as native
from .image_sources import Source
from .node_expressions import Sample
from .texture_coordinates import IDENTITY_2D, Coordinates

Channel = native.Channel


@dataclass(frozen=True)
class Baked:
    """A picture that is computed from others when it is added."""

    name: str
    steps: tuple[native.BakeStep, ...]
    samples: tuple[Sample, ...]  # mapped from the new picture's coordinates
    linear: bool


@dataclass(frozen=True)
class TextureUse:
    """The fields of the backend's texture."""

    picture: Source | Baked
    channel: int = Channel.COLOR
    extension: int = native.Extension.REPEAT
    closest: bool = False
    to_picture: tuple[float, ...] = IDENTITY_2D
    scale: Color = (1.0, 1.0, 1.0)
    offset: Color = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Value:
    """A constant, or a texture whose mean is asked for when it is added."""

    color: Color
    texture: TextureUse | None = None

    @property
    def number(self) -> float:
        return self.color[0]


@dataclass(frozen=True)
class VertexColors:
    """The color attribute ("": the one active for rendering) that counts, and for what."""

    name: str
    color: bool = True
    alpha: bool = False


def gray(value: float) -> Value:
    return Value((value, value, value))


class Constant(NamedTuple):
    """A number that the backend holds no texture for: its words in problems, and its range."""

    words: str
    least: float = 0.0
    most: float = 1.0


@dataclass(frozen=True)
class Look:
    """The backend's material without its name."""

    base_color: Value = gray(0.8)
    roughness: Value = gray(0.5)
    metallic: Value = gray(0.0)
    specular: float = 0.5
    emission: Value = gray(0.0)
    alpha: Value = gray(1.0)
    alpha_mode: int = native.AlphaMode.OPAQUE
    alpha_cutoff: float = 0.5
    transmission: float = 0.0
    ior: float = 1.45
    clearcoat: float = 0.0
    clearcoat_roughness: float = 0.03
    normal: TextureUse | None = None
    normal_strength: float = 1.0
    bump: TextureUse | None = None
    bump_distance: float = 0.0
    vertex_colors: VertexColors | None = None
    other: "Look | None" = None
    mix: Value = gray(0.0)
    coordinates: Coordinates | None = None  # those of all its textures; None: it has none
    # The mean light of all its surfaces together, which the bridge alone uses
    radiance: Color = field(default=(0.0, 0.0, 0.0), compare=False)


DEFAULT = Look(roughness=gray(0.4))  # Blender's own for an empty slot
CONSTANTS = {
    "specular": Constant("specular"),
    "transmission": Constant("transmission"),
    "ior": Constant("IOR", 0.1, 10.0),
    "clearcoat": Constant("clear coat"),
    "clearcoat_roughness": Constant("clear coat's roughness"),
}
TEXTURED = ("base_color", "roughness", "metallic", "emission", "alpha", "mix")
_LIMIT = 1e9


def add(model: Any, pictures: Any, name: str, look: Look) -> int:
    """The model's index of a look with the pictures it needs; that of what it is mixed with too."""
    fields: dict[str, Any] = {
        key: _within(getattr(look, key), one.least, one.most) for key, one in CONSTANTS.items()
    }
    fields["alpha_mode"] = look.alpha_mode
    fields["alpha_cutoff"] = _unit(look.alpha_cutoff)
    fields["normal_strength"] = _within(look.normal_strength, 0.0, 10.0)
    fields["bump_distance"] = _within(look.bump_distance, -_LIMIT, _LIMIT)
    fields["vertex_colors"] = int(look.vertex_colors is not None)
    if look.other is not None:
        fields["other"] = 1 + add(model, pictures, name, look.other)
    for key in TEXTURED:
        value: Value = getattr(look, key)
        color = value.color
        texture = None if value.texture is None else _texture(pictures, value.texture)
        if texture is not None:
            fields[f"{key}_texture"] = texture
            color = pictures.texture_mean(texture)
        if key in {"base_color", "emission"}:
            fields[key] = tuple(_positive(c) for c in color)
        else:
            fields[key] = _unit(color[0])
    for key in ("normal", "bump"):
        use = getattr(look, key)
        texture = None if use is None else _texture(pictures, use)
        if texture is not None:
            fields[f"{key}_texture"] = texture
    return model.add_material(name, **fields)


def _texture(pictures: Any, use: TextureUse) -> Any | None:
    """The texture of a use; None when its picture cannot be had after all."""
    if isinstance(use.picture, Baked):
        baked = use.picture
        samples = [
            (
                sample.source,
                {
                    "extension": sample.extension,
                    "closest": sample.closest,
                    "to_picture": sample.to_picture,
                },
            )
            for sample in baked.samples
        ]
        index = pictures.bake(baked.name, list(baked.steps), samples, baked.linear)
    else:
        index = pictures.index(use.picture)
    if index is None:
        return None
    return native.texture(
        index, use.channel, use.extension, use.closest, use.to_picture, use.scale, use.offset
    )


def _unit(value: float) -> float:
    return _within(value, 0.0, 1.0)


def _positive(value: float) -> float:
    return _within(value, 0.0, _LIMIT)


def _within(value: float, least: float, most: float) -> float:
    return min(most, max(least, value)) if value == value else least
