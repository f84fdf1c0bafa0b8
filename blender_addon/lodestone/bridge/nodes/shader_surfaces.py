# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces that shader nodes become: principled surfaces, mixtures of a few of them, and nothing;
still as expressions."""

from collections.abc import Callable
from dataclasses import dataclass, replace

from ...core.expression import color_expression as e
from ...core.expression.color_expression import Expression
from ...core.problems import WARNING
from .node_expressions import Note, mean_of

MOST_MIXED = 4  # surfaces in one material
_BLACK = e.ZERO


@dataclass(frozen=True)
class Relief:
    """Normal and bump maps: expressions of their texels, None where there is none."""

    normal: Expression | None = None
    strength: float = 1.0
    bump: Expression | None = None
    distance: float = 0.0  # metres from 0 to 1


FLAT = Relief()


@dataclass(frozen=True)
class Surface:
    """The backend's material before its textures are told apart from its constants."""

    base_color: Expression = e.number(0.8)
    roughness: Expression = e.number(0.5)
    metallic: Expression = e.ZERO
    specular: Expression = e.number(0.5)
    emission: Expression = e.ZERO
    alpha: Expression = e.ONE
    transmission: Expression = e.ZERO
    ior: Expression = e.number(1.45)
    clearcoat: Expression = e.ZERO
    clearcoat_roughness: Expression = e.number(0.03)
    relief: Relief = FLAT


@dataclass(frozen=True)
class Mixed:
    """Made by mixed(): of MOST_MIXED surfaces at most, none of them Clear."""

    first: Surface
    second: "Surface | Mixed"
    share: Expression  # the share of the second surface


@dataclass(frozen=True)
class Clear:
    """A surface that is none: what is behind is seen."""


Shader = Surface | Mixed | Clear
NOTHING = Surface(_BLACK, e.ONE, specular=e.ZERO)  # an unlinked shader: black


def mixed(first: Shader, second: Shader, share: Expression, note: Note, pictures: object) -> Shader:
    """Cut down at once: node trees share their branches, and all of them in every place would be
    more than can be counted."""
    if isinstance(first, Clear):
        return faded(second, share)
    if isinstance(second, Clear):
        return faded(first, e.subtract(e.ONE, share))
    if isinstance(first, Mixed) and isinstance(second, Surface):
        first, second, share = second, first, e.subtract(e.ONE, share)
    if isinstance(first, Mixed):
        note(WARNING, "mixed_shaders", "a mixture in a mixture is drawn as its main shader")
        first = _heaviest(first, pictures)
    chain = surfaces(second)
    if len(chain) >= MOST_MIXED:
        note(WARNING, "mixed_shaders", f"of its mixed shaders {MOST_MIXED} are drawn")
        chain = chain[: MOST_MIXED - 1]
    second = chain[-1][0]
    for surface, rest in reversed(chain[:-1]):
        second = Mixed(surface, second, rest)
    return Mixed(first, second, share)


def surfaces(shader: Shader) -> list[tuple[Surface, Expression]]:
    """The surfaces, each with its share of all that follows it."""
    if isinstance(shader, Clear):
        return [(Surface(alpha=e.ZERO), e.ZERO)]
    chain = []
    while isinstance(shader, Mixed):
        chain.append((shader.first, shader.share))
        shader = shader.second
    return [*chain, (shader, e.ZERO)]


def _heaviest(mixture: Mixed, pictures: object) -> Surface:
    left, best = 1.0, (-1.0, mixture.first)
    for surface, share in surfaces(mixture):
        rest = min(1.0, max(0.0, mean_of(share, pictures)[0]))
        best = max(best, (left * (1.0 - rest), surface), key=lambda pair: pair[0])
        left *= rest
    return best[1]


def faded(shader: Shader, share: Expression) -> Shader:
    """Covering only that share of what it covers."""
    if isinstance(shader, Clear):
        return shader
    if isinstance(shader, Mixed):
        return replace(shader, first=faded(shader.first, share), second=faded(shader.second, share))
    return replace(shader, alpha=e.multiply(shader.alpha, share))


def each_surface(shader: Shader, change: Callable[[Surface], Surface]) -> Shader:
    if isinstance(shader, Clear):
        return shader
    if isinstance(shader, Mixed):
        first, second = each_surface(shader.first, change), each_surface(shader.second, change)
        return replace(shader, first=first, second=second)
    return change(shader)
