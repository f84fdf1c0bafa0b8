# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights in Blender's units: sun W/m^2, point W."""

import math
from typing import Any

from mathutils import Matrix, Vector

from ..core.native import lodestone_native as native
from ..core.problems import INFO, WARNING, Problems

SOFT_SUN = math.radians(1.0)  # wider suns and
SOFT_RADIUS = 0.25  # larger lamps have shadows one sees to be soft


def add(model: Any, light: Any, matrix: Matrix, name: str, problems: Problems) -> None:
    """Adds an evaluated light datablock as placed by matrix; what is not exact is a problem."""
    color, power = tuple(light.color), light.energy
    position = tuple(matrix.translation)
    shadow = bool(light.use_shadow)
    if light.use_nodes and light.node_tree and _has_own_nodes(light.node_tree):
        text = f'Nodes of light "{name}" are left out; its color and power are used'
        problems.add(name, WARNING, "light_nodes", text)
    if light.type == "SUN":
        direction = matrix.to_3x3() @ Vector((0.0, 0.0, -1.0))
        if direction.length == 0.0:
            direction = Vector((0.0, 0.0, -1.0))
        if light.angle > SOFT_SUN:
            _soft(name, problems)
        model.add_light(
            name,
            native.LightKind.SUN,
            color,
            power,
            direction=tuple(direction.normalized()),
            shadow=shadow,
        )
        return
    if light.type == "POINT":
        if light.shadow_soft_size > SOFT_RADIUS:
            _soft(name, problems)
    else:
        # The nearest thing that lights what it faces: an area lamp sends pi times a point lamp's
        # light along its axis, a spot just a point lamp's.
        power *= math.pi if light.type == "AREA" else 1.0
        text = f'{light.type.capitalize()} light "{name}" is drawn as a point light'
        problems.add(name, WARNING, "light_kind", text)
    model.add_light(name, native.LightKind.POINT, color, power, position=position, shadow=shadow)


def _soft(name: str, problems: Problems) -> None:
    problems.add(name, INFO, "soft_shadow", f'Shadows of light "{name}" are drawn sharp')


def _has_own_nodes(tree: Any) -> bool:
    """More than the emission node a light starts with."""
    for node in tree.nodes:
        if node.type == "EMISSION":
            color, strength = node.inputs["Color"], node.inputs["Strength"]
            plain = not (color.is_linked or strength.is_linked)
            if plain and tuple(color.default_value[:3]) == (1.0, 1.0, 1.0):
                if strength.default_value == 1.0:
                    continue
            return True
        if node.type not in {"OUTPUT_LIGHT", "FRAME", "REROUTE"}:
            return True
    return False
