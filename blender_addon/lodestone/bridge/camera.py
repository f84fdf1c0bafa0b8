# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender camera as explicit frame vectors: no angle, no handedness flip, any sensor fit."""

from dataclasses import dataclass
from typing import Any

from mathutils import Vector

from ..core.native import lodestone_native as native
from ..core.problems import WARNING, Problems


@dataclass(frozen=True)
class Frame:
    """The picture's shape: its size in pixels and the width-to-height shape of one pixel."""

    width: int
    height: int
    aspect_x: float = 1.0
    aspect_y: float = 1.0

    @classmethod
    def of(cls, render: Any) -> "Frame":
        """Of RenderSettings, as Blender rounds."""
        scale = render.resolution_percentage / 100
        return cls(
            max(1, int(render.resolution_x * scale)),
            max(1, int(render.resolution_y * scale)),
            render.pixel_aspect_x,
            render.pixel_aspect_y,
        )


def view_plane(data: Any, frame: Frame) -> tuple[float, float, float, float]:
    """Width, height and center (x, y) of the picture at distance 1 (orthographic: in metres)."""
    tall = frame.aspect_y / frame.aspect_x
    wide_fit = data.sensor_fit == "HORIZONTAL" or (
        data.sensor_fit == "AUTO" and frame.width * frame.aspect_x >= frame.height * frame.aspect_y
    )
    factor = frame.width if wide_fit else tall * frame.height
    if data.type == "ORTHO":
        pixel = data.ortho_scale / factor
    else:
        sensor = data.sensor_height if data.sensor_fit == "VERTICAL" else data.sensor_width
        pixel = sensor / data.lens / factor
    return (
        frame.width * pixel,
        tall * frame.height * pixel,
        data.shift_x * factor * pixel,
        data.shift_y * factor * pixel,
    )


def extract(camera: Any, frame: Frame, problems: Problems) -> Any:
    """Of an evaluated camera object."""
    data = camera.data
    if data.type == "PANO":
        text = f'Camera "{camera.name}" is panoramic; it is drawn as a perspective camera'
        problems.add(camera.name, WARNING, "camera_panoramic", text)
    if data.type != "PANO" and data.dof.use_dof:
        text = f'Depth of field of camera "{camera.name}" is left out'
        problems.add(camera.name, WARNING, "depth_of_field", text)
    matrix = camera.matrix_world.normalized()
    turn, place = matrix.to_3x3(), matrix.translation
    width, height, center_x, center_y = view_plane(data, frame)
    orthographic = data.type == "ORTHO"
    if orthographic:
        position = place + turn @ Vector((center_x, center_y, 0.0))
        direction = turn @ Vector((0.0, 0.0, -1.0))
    else:
        position = place
        direction = turn @ Vector((center_x, center_y, -1.0))
    return native.Camera(
        name=camera.name,
        orthographic=orthographic,
        position=tuple(position),
        direction=tuple(direction),
        right=tuple(turn @ Vector((width, 0.0, 0.0))),
        up=tuple(turn @ Vector((0.0, height, 0.0))),
        near_clip=data.clip_start,
    )
