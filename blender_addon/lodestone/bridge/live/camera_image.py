# SPDX-License-Identifier: GPL-3.0-or-later
"""The image of the scene's camera in a region of the window that looks through it."""

from typing import Any

from bpy_extras.view3d_utils import location_3d_to_region_2d
from mathutils import Vector

Corners = tuple[float, float, float, float]  # left, bottom, right, top, in pixels


def image_corners(scene: Any, region: Any, region_3d: Any) -> Corners | None:
    """The corners of the image in a region that looks through the scene's camera, in
    pixels; None when it has no extent."""
    item = scene.camera
    frame = item.data.view_frame(scene=scene)
    places = [item.matrix_world @ Vector(corner) for corner in frame]
    shown = [location_3d_to_region_2d(region, region_3d, place) for place in places]
    if any(place is None for place in shown):
        return None
    columns, rows = [p.x for p in shown], [p.y for p in shown]
    corners = (min(columns), min(rows), max(columns), max(rows))
    return corners if corners[2] > corners[0] and corners[3] > corners[1] else None


def on_image(corners: Corners, x: float, y: float) -> tuple[float, float] | None:
    """A place in the region as shares of the image; None without extent."""
    left, bottom, right, top = corners
    if right <= left or top <= bottom:
        return None
    return (x - left) / (right - left), (y - bottom) / (top - bottom)
