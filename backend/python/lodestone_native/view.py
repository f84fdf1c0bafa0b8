# SPDX-License-Identifier: GPL-3.0-or-later
"""Camera and view: plain values that a cut and an export are made for."""

from dataclasses import dataclass

from . import structs
from .enums import LightKind

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Camera:
    """Perspective: pixel (u, v) in [-1/2, 1/2]^2 looks along direction + u right + v up from
    position. Orthographic: along direction from position + u right + v up."""

    name: str
    orthographic: bool
    position: Vector
    direction: Vector
    right: Vector
    up: Vector
    near_clip: float
    focus_distance: float = 0.0  # metres along the view; 0: all is sharp
    aperture: float = 0.0  # diameter, metres

    def struct(self) -> structs.Camera:
        return structs.Camera(
            name=structs.text_in(self.name),
            orthographic=int(self.orthographic),
            position=self.position,
            direction=self.direction,
            right=self.right,
            up=self.up,
            near_clip=self.near_clip,
            focus_distance=self.focus_distance,
            aperture=self.aperture,
        )


@dataclass(frozen=True)
class Light:
    """In Blender's energy units: suns W/m^2, others W; negative power takes light away."""

    name: str
    kind: LightKind
    color: Vector = (1.0, 1.0, 1.0)  # linear
    power: float = 1.0
    position: Vector = (0.0, 0.0, 0.0)  # all but suns; an area's center
    direction: Vector = (0.0, 0.0, -1.0)  # all but points: the way the light travels
    shadow: bool = True
    radius: float = 0.0  # point, spot: metres
    angle: float = 0.0  # sun: its diameter in the sky, radians
    spot_size: float = 0.785  # the whole cone, radians
    spot_blend: float = 0.0
    edge_u: Vector = (1.0, 0.0, 0.0)  # area: its width and height
    edge_v: Vector = (0.0, 1.0, 0.0)
    round: bool = False  # area: the ellipse inside the edges
    spread: float = 0.0  # area: radians; 0: the whole half space

    def struct(self) -> structs.Light:
        values = {**vars(self), "name": structs.text_in(self.name)}
        return structs.Light(**{**values, "shadow": int(self.shadow), "round": int(self.round)})


@dataclass(frozen=True)
class View:
    """Pixel Error in pixels of the final image: larger is coarser and cheaper, 0 = originals."""

    camera: Camera
    width: int
    height: int
    pixel_error: float = 1.0
    kinds: int = 0  # bit (1 << Kind) for each kind the consumer can draw; 0 = all
    border: tuple[int, int, int, int] = (0, 0, 0, 0)  # left, top, width, height; width 0: all

    def struct(self) -> structs.View:
        return structs.View(
            camera=self.camera.struct(),
            width=self.width,
            height=self.height,
            pixel_error=self.pixel_error,
            kinds=self.kinds,
            border=self.border,
        )
