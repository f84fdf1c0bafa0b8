# SPDX-License-Identifier: GPL-3.0-or-later
"""Camera and view: plain values that a cut and an export are made for."""

from dataclasses import dataclass

from . import structs

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

    def struct(self) -> structs.Camera:
        return structs.Camera(
            name=structs.text_in(self.name),
            orthographic=int(self.orthographic),
            position=self.position,
            direction=self.direction,
            right=self.right,
            up=self.up,
            near_clip=self.near_clip,
        )


@dataclass(frozen=True)
class View:
    """Pixel Error in pixels of the final image: larger is coarser and cheaper, 0 = originals."""

    camera: Camera
    width: int
    height: int
    pixel_error: float = 1.0
    kinds: int = 0  # bit (1 << Kind) for each kind the consumer can draw; 0 = all

    def struct(self) -> structs.View:
        return structs.View(
            camera=self.camera.struct(),
            width=self.width,
            height=self.height,
            pixel_error=self.pixel_error,
            kinds=self.kinds,
        )
