# SPDX-License-Identifier: GPL-3.0-or-later
"""The world as one color: exact for a flat background, else its mean, named."""

from typing import Any

from ..core.problems import WARNING, Problems
from .images import ImageMeans
from .node_values import NodeValues


# Mean radiance of the upper half of Blender's sky textures with their default settings, measured
# with Cycles in 3.4: drawn in one color a sky still lights as much as it would.
_SKIES = {
    "PREETHAM": (0.415, 0.602, 1.056),
    "HOSEK_WILKIE": (0.0676, 0.1076, 0.1739),
    "NISHITA": (3.27, 3.54, 3.73),
}


def color(
    world: Any | None, problems: Problems, images: ImageMeans | None = None
) -> tuple[float, float, float]:
    """Linear radiance of an evaluated world; no world is black."""
    if world is None:
        return (0.0, 0.0, 0.0)
    if not world.use_nodes or world.node_tree is None:
        return tuple(world.color)
    name = world.name

    def note(code: str, text: str) -> None:
        message = f'World "{name}": drawn as one flat color ({text})'
        problems.add(name, WARNING, f"world_{code}", message)

    output = world.node_tree.get_output_node("ALL")
    node = _background(output.inputs["Surface"], set()) if output else None
    if node is None:
        if output and output.inputs["Surface"].is_linked:
            note("shader", "its shader is not known")
            return tuple(world.color)
        return (0.0, 0.0, 0.0)
    images = images or ImageMeans()
    values = NodeValues(images, note)
    source = node.inputs["Color"]
    tint = _environment(source, images, note)
    if tint is None:
        tint = values.color(source)
    strength = values.number(node.inputs["Strength"])
    return tuple(min(1e9, max(0.0, strength * c)) for c in tint)


def _background(socket: Any, seen: set) -> Any | None:
    """The first background node that feeds this socket."""
    for link in socket.links:
        node = link.from_node
        if node.name in seen:
            continue
        seen.add(node.name)
        if node.type == "BACKGROUND":
            return node
        for inner in node.inputs:
            found = _background(inner, seen)
            if found is not None:
                return found
    return None


def _environment(socket: Any, images: ImageMeans, note: Any) -> Any | None:
    """The mean of an environment or sky texture right behind the socket."""
    if not socket.is_linked:
        return None
    node = socket.links[0].from_node
    if node.type == "TEX_ENVIRONMENT" and node.image is not None:
        mean = images.mean(node.image)
        if mean is not None:
            note("texture_mean", "the mean of its environment texture")
        return mean
    if node.type == "TEX_SKY":
        note("sky", "the mean of a sky like it")
        return _SKIES.get(node.sky_type, _SKIES["HOSEK_WILKIE"])
    return None
