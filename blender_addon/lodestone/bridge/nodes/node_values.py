# SPDX-License-Identifier: GPL-3.0-or-later
"""Mean colors and numbers of node sockets, for what is drawn in one color."""

from collections.abc import Callable
from typing import Any

from ...core.expression import color_expression as e
from ...core.expression.color_expression import Color
from .image_means import ImageMeans
from .image_sources import MISSING, Source
from .node_expressions import NodeExpressions, mean_of


class NodeValues:
    """`note(code, text)` is told about every value that is not exact."""

    def __init__(self, images: ImageMeans, note: Callable[[str, str], None]) -> None:
        self._means = _Means(images)
        self._note = note
        self._nodes = NodeExpressions(self._means, lambda _, code, text: note(code, text))

    def color(self, socket: Any, groups: tuple = (), depth: int = 0) -> Color:
        """The socket's linear color; `groups` are the group nodes around it, outermost first."""
        return self._mean(self._nodes.color(socket, groups, depth))

    def number(self, socket: Any, groups: tuple = (), depth: int = 0) -> float:
        return self._mean(self._nodes.number(socket, groups, depth))[0]

    def _mean(self, value: e.Expression) -> Color:
        if e.leaves(value):
            self._note("texture_mean", "textures are drawn as their mean color")
        return mean_of(value, self._means)


class _Means:
    """Stands where Pictures does."""

    def __init__(self, images: ImageMeans) -> None:
        self._images = images

    def index(self, source: Source) -> int | None:
        return None if self.mean(source) is None else 0

    def mean(self, source: Source) -> tuple[float, float, float, float] | None:
        mean = None if source.kind == MISSING else self._images.mean(source.image)
        return None if mean is None else (*mean, 1.0)
