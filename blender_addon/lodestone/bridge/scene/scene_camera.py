# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender camera as explicit frame vectors: no angle, no handedness flip, any sensor fit."""

from dataclasses import dataclass
from typing import Any

from mathutils import Vector

from ...core.native import lodestone_native as native
from ...core.problems import INFO, WARNING, Problems
from ..datablock_ids import name_of

_CLIP_START = 0.101  # metres; new cameras have 0.1, so who has more wants something cut away
_PICTURE = {"Image", "Alpha"}  # the passes of a view layer that there are for the compositor


@dataclass(frozen=True)
class Frame:
    """The picture's shape: its size in pixels and the width-to-height shape of one pixel."""

    width: int
    height: int
    aspect_x: float = 1.0
    aspect_y: float = 1.0

    @classmethod
    def of(cls, render: Any) -> "Frame":
        """The frame of RenderSettings, as Blender rounds: in whole numbers (29 % of 100 are 29)."""
        percent = render.resolution_percentage
        return cls(
            max(1, render.resolution_x * percent // 100),
            max(1, render.resolution_y * percent // 100),
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
    """The camera of an evaluated camera object."""
    data = camera.data
    if data.type == "PANO":
        text = f'Camera "{name_of(camera)}" is panoramic; it is drawn as a perspective camera'
        problems.add(name_of(camera), WARNING, "camera_panoramic", text)
    if data.clip_start > _CLIP_START:
        text = f'Camera "{name_of(camera)}" clips nothing: what is nearer than its start is drawn'
        problems.add(name_of(camera), WARNING, "clip_start", text)
    focus_distance, aperture = depth_of_field(camera, problems)
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
        name=name_of(camera),
        orthographic=orthographic,
        position=tuple(position),
        direction=tuple(direction),
        right=tuple(turn @ Vector((width, 0.0, 0.0))),
        up=tuple(turn @ Vector((0.0, height, 0.0))),
        near_clip=data.clip_start,
        focus_distance=focus_distance,
        aperture=aperture,
    )


def depth_of_field(camera: Any, problems: Problems) -> tuple[float, float]:
    """Distance to the sharp plane and diameter of the lens's opening as Cycles has them, in metres;
    (0, 0) when everything is sharp."""
    data = camera.data
    dof = data.dof
    if not dof.use_dof or data.type == "PANO":
        return (0.0, 0.0)
    stop = max(dof.aperture_fstop, 1e-5)
    lens = 1.0 if data.type == "ORTHO" else data.lens * 1e-3
    if dof.aperture_blades > 2 or dof.aperture_ratio != 1.0:
        text = f'Blades of the lens of camera "{name_of(camera)}" are left out: its blur is round'
        problems.add(name_of(camera), INFO, "lens_blades", text)
    return (focus_distance(camera), lens / stop)


def focus_distance(camera: Any) -> float:
    """Metres to the plane in focus, whether or not anything is blurred."""
    dof = camera.data.dof
    distance = dof.focus_distance
    if dof.focus_object is not None:
        matrix = camera.matrix_world
        ahead = matrix.col[2].to_3d().normalized()
        distance = abs(ahead.dot(matrix.translation - _focus_place(dof)))
    return max(distance, 1e-5)


def _focus_place(dof: Any) -> Vector:
    """The place of the focus object, or of the bone of it that is named."""
    item = dof.focus_object
    bone = item.pose.bones.get(dof.focus_subtarget) if item.pose else None
    return (item.matrix_world @ bone.matrix if bone else item.matrix_world).translation


def report_render(scene: Any, problems: Problems) -> None:
    """Names what the settings of an evaluated scene ask for and pictures lack."""
    render, name = scene.render, name_of(scene)
    if render.use_motion_blur:
        text = f'Motion blur of scene "{name}" is left out'
        problems.add(name, WARNING, "motion_blur", text)
    if render.use_multiview:
        text = f'Scene "{name}" is stereoscopic; every eye gets the same picture'
        problems.add(name, WARNING, "stereo", text)
    if render.use_compositing and scene.use_nodes and scene.node_tree is not None:
        for passed in _passes_read(scene.node_tree):
            text = f'Compositor of scene "{name}": pass "{passed}" is empty'
            problems.add(name, WARNING, "empty_pass", text)


def _passes_read(tree: Any) -> list[str]:
    """Passes besides the picture that the compositor reads of rendered layers."""
    found = {
        name_of(socket)
        for node in tree.nodes
        if node.type == "R_LAYERS" and not node.mute
        for socket in node.outputs
        if socket.is_linked
    }
    return sorted(found - _PICTURE)
