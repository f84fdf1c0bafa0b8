# SPDX-License-Identifier: GPL-3.0-or-later
"""The camera of a 3D view by explicit frame vectors, as scene_camera.py has a scene's."""

from typing import Any

from mathutils import Vector

from ...core.native import lodestone_native as native

NEAREST = 1e-4  # metres: a near clip that is none


def of_screen(screen: Any) -> tuple[Any, tuple[int, int]] | None:
    """The camera and the size in pixels of the largest 3D view of a screen; None: it has none."""
    areas = [area for area in (screen.areas if screen else ()) if area.type == "VIEW_3D"]
    if not areas:
        return None
    area = max(areas, key=lambda area: area.width * area.height)
    region = next((item for item in area.regions if item.type == "WINDOW"), None)
    if region is None or region.width < 1 or region.height < 1:
        return None
    space = area.spaces.active
    camera = camera_of(space.region_3d.view_matrix, space.region_3d.window_matrix, space.clip_start)
    return None if camera is None else (camera, (region.width, region.height))


def camera_of(view_matrix: Any, window_matrix: Any, near: float) -> Any | None:
    """The camera of a view by its two matrices; None for one that sees no volume."""
    across, up = window_matrix[0][0], window_matrix[1][1]
    if not (across > 0.0 and up > 0.0):
        return None
    try:
        inverse = view_matrix.inverted()
    except ValueError:
        return None
    turn, place = inverse.to_3x3(), inverse.translation
    orthographic = window_matrix[3][3] != 0.0
    column = 3 if orthographic else 2
    sign = -1.0 if orthographic else 1.0
    middle = (sign * window_matrix[0][column] / across, sign * window_matrix[1][column] / up)
    if orthographic:
        place = place + turn @ Vector((*middle, 0.0))
        direction = turn @ Vector((0.0, 0.0, -1.0))
    else:
        direction = turn @ Vector((*middle, -1.0))
    return native.Camera(
        name="3D view",
        orthographic=orthographic,
        position=tuple(place),
        direction=tuple(direction),
        right=tuple(turn @ Vector((2.0 / across, 0.0, 0.0))),
        up=tuple(turn @ Vector((0.0, 2.0 / up, 0.0))),
        near_clip=max(near, NEAREST),
    )
