# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair as flat buffers: particle hair, as it is rendered, and hair curves."""

import math
from array import array
from collections.abc import Iterator
from typing import Any

from ...core.native import lodestone_native as native

CURVES_RADIUS = 0.005  # metres, of hair curves that have none of their own (as Cycles)
_ORIGIN = (0.0, 0.0, 0.0)


def hair_modifiers(shown: Any) -> Iterator[Any]:
    """The modifiers of the particle systems of an evaluated object that render as hair."""
    for modifier in shown.modifiers:
        if modifier.type == "PARTICLE_SYSTEM" and modifier.show_render:
            settings = modifier.particle_system.settings
            if settings.type == "HAIR" and settings.render_type == "PATH":
                yield modifier


def drawn_particles(system: Any) -> range:
    """Numbers of the hairs that are drawn: the children in place of their parents, if any."""
    parents, children = len(system.particles), len(system.child_particles)
    first = parents if children and system.settings.child_type != "NONE" else 0
    return range(first, parents + children)


def hair(shown: Any, slot_count: int, with_uvs: bool) -> Any:
    """StrandBuffers of all hair of an evaluated object, in its frame; None without any. Only
    inside the loop over depsgraph instances: hair is told in world space."""
    points, radii, counts, slots = array("f"), array("f"), array("I"), array("i")
    layers = enumerate(shown.data.uv_layers) if with_uvs else ()
    layer = next((number for number, item in layers if item.active_render), None)
    uvs = None if layer is None else array("f")
    to_object = shown.matrix_world.inverted_safe()
    for modifier in hair_modifiers(shown):
        system = modifier.particle_system
        settings, particles = system.settings, system.particles
        steps = (1 << settings.render_step) + 1
        if settings.kink == "SPIRAL":
            steps += settings.kink_extra_steps
        slot = min(max(settings.material - 1, 0), max(slot_count - 1, 0))
        key_at = system.co_hair
        for number in drawn_particles(system):
            keys = [key_at(shown, particle_no=number, step=step) for step in range(steps)]
            while keys and tuple(keys[-1]) == _ORIGIN:  # past the end of a shorter hair
                keys.pop()
            if len(keys) < 2:
                continue
            keys = [to_object @ key for key in keys]
            for key in keys:
                points.extend(key)
            radii.extend(_radii(settings, keys))
            counts.append(len(keys))
            slots.append(slot)
            if uvs is not None:
                particle = particles[min(number, len(particles) - 1)]
                root = system.uv_on_emitter(
                    modifier, particle=particle, particle_no=number, uv_no=layer
                )
                uvs.extend(root[:2])
    return native.StrandBuffers(points, radii, counts, slots, uvs) if counts else None


def _radii(settings: Any, keys: list) -> list[float]:
    """Half of the diameters Blender shows: from root to tip by the length gone, bent by shape."""
    root = 0.5 * settings.radius_scale * settings.root_radius
    tip = 0.5 * settings.radius_scale * settings.tip_radius
    gone = [0.0]
    for before, key in zip(keys, keys[1:]):
        gone.append(gone[-1] + (key - before).length)
    whole = gone[-1] or 1.0
    found = [tip + (root - tip) * _shaped(1.0 - part / whole, settings.shape) for part in gone]
    if settings.use_close_tip:
        found[-1] = 0.0
    return found


def _shaped(left: float, shape: float) -> float:
    """The share of the root's radius that is left with this share of the hair to go: `shape` -1
    keeps it to the tip, 0 lets it fall evenly, 1 loses it at once."""
    if left <= 0.0 or left >= 1.0:
        return min(max(left, 0.0), 1.0)
    if shape < 0.0:
        return left ** (1.0 + shape)
    return left ** (1.0 / (1.0 - shape)) if shape < 1.0 else 0.0


def curves(data: Any) -> Any:
    """StrandBuffers of an evaluated hair curves datablock, in its frame; None without any."""
    point_count, curve_count = len(data.points), len(data.curves)
    if point_count == 0 or curve_count == 0:
        return None
    points = array("f", bytes(12 * point_count))
    data.points.foreach_get("position", points)
    if "radius" in data.attributes:
        radii = array("f", bytes(4 * point_count))
        data.points.foreach_get("radius", radii)
    else:
        radii = array("f", [CURVES_RADIUS]) * point_count
    offsets = array("i", bytes(4 * (curve_count + 1)))
    data.curve_offset_data.foreach_get("value", offsets)
    counts = array("I", (high - low for low, high in zip(offsets, offsets[1:])))
    return native.StrandBuffers(points, radii, counts)


def point_cloud(data: Any) -> list[tuple[tuple[float, float, float], float]]:
    """The points of a cloud that have a size, (center, radius) of each, in the cloud's frame."""
    count = len(data.points)
    places = array("f", bytes(12 * count))
    data.points.foreach_get("co", places)
    radii = array("f", bytes(4 * count))
    data.points.foreach_get("radius", radii)
    values = iter(places)
    return [
        (center, radius)
        for center, radius in zip(zip(values, values, values), radii)
        if radius > 0.0 and math.isfinite(radius + sum(center))
    ]
