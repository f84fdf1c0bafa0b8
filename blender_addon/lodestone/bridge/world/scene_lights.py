# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights in Blender's units (sun W/m^2, others W), with the sizes that make their shadows soft."""

import math
from dataclasses import replace
from typing import Any

from mathutils import Matrix, Vector

from ...core.native import lodestone_native as native
from ...core.problems import INFO, WARNING, Problems
from ..nodes.image_means import ImageMeans
from ..nodes.node_graph import feed
from ..nodes.node_values import NodeValues

_KINDS = {
    "SUN": native.LightKind.SUN,
    "POINT": native.LightKind.POINT,
    "SPOT": native.LightKind.SPOT,
    "AREA": native.LightKind.AREA,
}


def add(model: Any, light: Any, matrix: Matrix, name: str, problems: Problems) -> None:
    """Adds an evaluated light datablock as placed by matrix; what is not exact is a problem."""
    emission = _emission(light)
    if emission is None:
        emission = (1.0, 1.0, 1.0)
        text = f'Nodes of light "{name}" are left out; its color and power are used'
        problems.add(name, WARNING, "light_nodes", text)
    cycles = getattr(light, "cycles", None)  # Cycles' own settings, where it is enabled
    if light.type == "AREA" and getattr(cycles, "is_portal", False):
        return  # a hint for Cycles' sampling, which gives no light
    color = tuple(own * times for own, times in zip(light.color, emission))
    values = [*matrix.translation, *color, light.energy]
    if not all(math.isfinite(value) for row in (values, *matrix) for value in row):
        text = f'Light "{name}" is left out: its place or its power is not a number'
        problems.add(name, WARNING, "bad_light", text)
        return
    given = native.Light(
        name=name,
        kind=_KINDS[light.type],
        color=color,
        power=light.energy,
        position=tuple(matrix.translation),
        direction=_direction(matrix),
        shadow=bool(light.use_shadow and getattr(cycles, "cast_shadow", True)),
        **_shape(light, matrix),
    )
    if light.type == "AREA" and _sheared(given):
        text = f'Parents shear area light "{name}": it gives about as much light as in Cycles'
        problems.add(name, WARNING, "light_sheared", text)
        if not given.round:  # Cycles lights by the plane of its edges then
            given = replace(given, direction=_square_to(given))
    if light.type == "SPOT" and light.use_square:
        text = f'Spot light "{name}" is drawn round, as Cycles does: not square'
        problems.add(name, INFO, "spot_square", text)
    _name_limits(given, problems)
    model.add_light(given)


def _name_limits(light: native.Light, problems: Problems) -> None:
    """Names what the export will say of it (in these words, so that it counts once), for those who
    want to know before."""
    if light.power == 0.0 or max(light.color) == 0.0 or light.kind < native.LightKind.SPOT:
        return
    if not light.shadow:
        text = "casts shadows all the same: POV-Ray has no spot or area light without"
        problems.add(light.name, WARNING, "light_shadow", text)
    if light.kind != native.LightKind.AREA:
        return
    if Vector(light.edge_u).cross(Vector(light.edge_v)).length == 0.0:
        text = "is an area light without an area: it gives no light, as in Cycles"
        problems.add(light.name, INFO, "light_size", text)
    elif 0.0 < light.spread < math.pi - 0.02:
        text = "its spread is drawn as a cone of about the same shape"
        problems.add(light.name, INFO, "light_spread", text)


def _direction(matrix: Matrix) -> tuple[float, float, float]:
    """The way the light travels: -Z, whatever the scale."""
    direction = matrix.to_3x3() @ Vector((0.0, 0.0, -1.0))
    if direction.length == 0.0:
        return (0.0, 0.0, -1.0)
    return tuple(direction.normalized())


def _square_to(light: native.Light) -> tuple[float, float, float]:
    """Square to the edges of an area, on the side it shines to."""
    square = Vector(light.edge_u).cross(Vector(light.edge_v)).normalized()
    return tuple(square if square.dot(Vector(light.direction)) >= 0.0 else -square)


def _sheared(light: native.Light) -> bool:
    """Whether an area does not look straight along what it shines: more than 2 degrees aside."""
    u, v = Vector(light.edge_u), Vector(light.edge_v)
    square = u.cross(v)
    if square.length <= 1e-6 * u.length * v.length:  # without an area there is nothing to tell
        return False
    return abs(square.normalized().dot(Vector(light.direction))) < 0.9994


def _shape(light: Any, matrix: Matrix) -> dict[str, Any]:
    """The values that lights of its kind have besides. Scaling an object changes the size of area
    lights alone."""
    if light.type == "SUN":
        return {"angle": min(math.pi, light.angle)}
    if light.type == "POINT":
        return {"radius": light.shadow_soft_size}
    if light.type == "SPOT":
        return {
            "radius": light.shadow_soft_size,
            "spot_size": min(math.pi, light.spot_size),
            "spot_blend": light.spot_blend,
        }
    width = light.size
    height = light.size_y if light.shape in {"RECTANGLE", "ELLIPSE"} else width
    axes = matrix.to_3x3()
    return {
        "edge_u": tuple(width * axes.col[0]),
        "edge_v": tuple(height * axes.col[1]),
        "round": light.shape in {"DISK", "ELLIPSE"},
        "spread": min(math.pi, light.spread),
    }


def _emission(light: Any) -> tuple[float, ...] | None:
    """The factor by which the light's nodes multiply its color: all black without a shader, as in
    Cycles; None when it is not the same everywhere."""
    if not light.use_nodes or light.node_tree is None:
        return (1.0, 1.0, 1.0)
    output = light.node_tree.get_output_node("CYCLES")
    behind = None if output is None else feed(output.inputs["Surface"])
    if behind is None or behind.node is None:
        return (0.0, 0.0, 0.0)
    if behind.node.type != "EMISSION":
        return None
    inexact: list[str] = []
    values = NodeValues(ImageMeans(), lambda code, text: inexact.append(code))
    color = values.color(behind.node.inputs["Color"], behind.groups)
    strength = values.number(behind.node.inputs["Strength"], behind.groups)
    return None if inexact else tuple(strength * value for value in color[:3])
