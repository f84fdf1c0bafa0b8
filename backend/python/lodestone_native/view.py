# SPDX-License-Identifier: GPL-3.0-or-later
"""Camera and view: plain values that a cut and an export are made for."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from typing import Any

from . import structs
from .base import text_in
from .enums import Criterion, LensFilter, LensShape, LightKind, OffScreen

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
            name=text_in(self.name),
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
        values: dict[str, Any] = {**vars(self), "name": text_in(self.name)}
        values.update(shadow=int(self.shadow), round=int(self.round))
        return structs.Light(**values)


@dataclass(frozen=True)
class Lens:
    """A region of the world where everything is drawn `strength` times finer (below 1: coarser),
    less so towards its rim. The unit of its frame is the radius' unit."""

    name: str
    transform: tuple[float, ...]  # its frame -> the world, 3 x 4 by rows
    shape: LensShape = LensShape.SPHERE
    radius: float = 1.0  # a box: half its sides
    strength: float = 4.0
    falloff: float = 1.0  # 0: the same everywhere inside
    filter: LensFilter = LensFilter.ALL
    objects: tuple[structs.Object, ...] = ()  # what the filter is about: objects and groups

    def struct(self) -> structs.Lens:
        return structs.Lens(
            shape=self.shape,
            transform=self.transform,
            radius=self.radius,
            strength=self.strength,
            falloff=self.falloff,
            filter=self.filter,
            name=text_in(self.name),
            objects=(structs.Object * len(self.objects))(*self.objects),
            object_count=len(self.objects),
        )


@dataclass(frozen=True)
class ScreenLens:
    """The same on the image: a disc."""

    name: str
    center: tuple[float, float]  # from the left and the top
    radius: float
    strength: float = 4.0
    falloff: float = 1.0
    in_pixels: bool = False  # else shares of width and height; the radius: of the width

    def struct(self) -> structs.ScreenLens:
        values: dict[str, Any] = {**vars(self), "name": text_in(self.name)}
        values.update(in_pixels=int(self.in_pixels))
        return structs.ScreenLens(**values)


@dataclass(frozen=True)
class Modifiers:
    """All that bends quality. Factors multiply, their product stays within 1/64 to 64."""

    lenses: tuple[Lens, ...] = ()
    screen_lenses: tuple[ScreenLens, ...] = ()
    depth: float = 1.0  # exaggeration k: coarser by (z / depth_focus)^(k - 1)
    depth_focus: float = 10.0  # metres
    when_moving: bool = False
    when_dark: bool = False
    off_screen: OffScreen = OffScreen.FULL
    ray_classes: int = 0  # of Rays: they may meet coarser representations than the camera's rays
    closing: Camera | None = None  # the camera when the shutter closes
    criterion: Criterion = Criterion.RESOLUTION

    def struct(self) -> structs.Modifiers:
        lenses = [lens.struct() for lens in self.lenses]
        screen_lenses = [lens.struct() for lens in self.screen_lenses]
        values: dict[str, Any] = dict(vars(self))  # those that are not set below are numbers
        values.update(
            lenses=(structs.Lens * len(lenses))(*lenses),
            lens_count=len(lenses),
            screen_lenses=(structs.ScreenLens * len(screen_lenses))(*screen_lenses),
            screen_lens_count=len(screen_lenses),
            closing=ctypes.pointer(self.closing.struct()) if self.closing else None,
        )
        return structs.Modifiers(**values)


@dataclass(frozen=True)
class Budget:
    """What a cut may cost at most; 0: any number."""

    triangles: int = 0  # placed
    bytes: int = 0  # in POV-Ray's memory

    def struct(self) -> structs.Budget:
        return structs.Budget(triangles=self.triangles, bytes=self.bytes)


@dataclass(frozen=True)
class View:
    """Pixel Error in pixels of the final image: larger is coarser and cheaper, 0 = originals."""

    camera: Camera
    width: int
    height: int
    pixel_error: float = 1.0
    kinds: int = 0  # bit (1 << Kind) for each kind the consumer can draw; 0 = all
    border: tuple[int, int, int, int] = (0, 0, 0, 0)  # left, top, width, height; width 0: all
    modifiers: Modifiers | None = None

    def struct(self) -> structs.View:
        return structs.View(
            camera=ctypes.pointer(self.camera.struct()),
            width=self.width,
            height=self.height,
            pixel_error=self.pixel_error,
            kinds=self.kinds,
            border=self.border,
            modifiers=ctypes.pointer(self.modifiers.struct()) if self.modifiers else None,
        )
