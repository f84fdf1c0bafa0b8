# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's images as the backend's pictures, added when something first needs them.

Files that the backend reads itself never pass through Blender's memory.
"""

from typing import Any

from ...core.expression.color_expression import Color
from ...core.native import lodestone_native as native
from .image_pixels import read_pixels, with_four_channels
from .image_sources import FILE, MISSING, PACKED, Source

Texel = tuple[float, float, float, float]


class Pictures:
    """The pictures of one model."""

    def __init__(self, model: Any) -> None:
        self._model = model
        self._found: dict[Source, int | None] = {}
        self._means: dict[Source, Texel] = {}

    def index(self, source: Source) -> int | None:
        """The model's index of a picture; None when it cannot be read."""
        if source not in self._found:
            self._found[source] = self._add(source)
        return self._found[source]

    def mean(self, source: Source) -> Texel | None:
        """Linear color weighted by alpha, and alpha; None when it cannot be read."""
        if source not in self._means:
            index = self.index(source)
            if index is None:
                return None
            color = self._model.texture_mean(native.texture(index))
            channel = native.texture(index, channel=native.Channel.ALPHA)
            opaque = not source.has_alpha
            share = 1.0 if opaque else self._model.texture_mean(channel)[0]
            self._means[source] = (color[0], color[1], color[2], share)
        return self._means[source]

    def bake(
        self, name: str, steps: list[native.BakeStep], samples: list[Any], linear: bool
    ) -> int | None:
        """The index of a picture computed of samples: (source, native.texture fields)."""
        textures = []
        for source, fields in samples:
            index = self.index(source)
            if index is None:
                return None
            textures.append(native.texture(index, **fields))
        try:
            return self._model.bake_picture(name, steps, textures, linear=linear)
        except native.LodestoneError as error:
            if error.status in {native.Status.OUT_OF_MEMORY, native.Status.INVALID_ARGUMENT}:
                return None
            raise

    def texture_mean(self, texture: Any) -> Color:
        return self._model.texture_mean(texture)

    def _add(self, source: Source) -> int | None:
        if source.kind == MISSING:
            return None
        try:
            if source.kind == FILE:
                return self._model.add_picture(source.name, path=source.path, linear=source.linear)
            if source.kind == PACKED:
                data = source.image.packed_file.data
                return self._model.add_picture(source.name, data=data, linear=source.linear)
        except native.LodestoneError as error:
            if error.status not in {native.Status.BAD_FILE, native.Status.IO}:
                raise
        return self._add_pixels(source)

    def _add_pixels(self, source: Source) -> int | None:
        """Adds a picture by way of Blender's own reader."""
        found = read_pixels(source.image)
        if found is None:
            return None
        pixels, size = with_four_channels(found), (found.width, found.height)
        linear = source.linear or found.floats
        try:
            return self._model.add_picture(source.name, pixels=pixels, size=size, linear=linear)
        except native.LodestoneError as error:
            if error.status in {native.Status.OUT_OF_MEMORY, native.Status.INVALID_ARGUMENT}:
                return None
            raise


class NoPictures:
    """Stands where Pictures does when only problems are looked for: reads no image."""

    def index(self, source: Source) -> int | None:
        return None if source.kind == MISSING else 0

    def mean(self, source: Source) -> Texel | None:
        return None if source.kind == MISSING else (0.5, 0.5, 0.5, 1.0)

    def bake(self, name: str, steps: list, samples: list[Any], linear: bool) -> int | None:
        return 0

    def texture_mean(self, texture: Any) -> Color:
        return (0.5, 0.5, 0.5)
