# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes, polygons and strands in flat buffers, as the library reads them in place."""

from __future__ import annotations

from array import array
from ctypes import c_float, c_int32, c_uint8, c_uint32
from dataclasses import dataclass
from typing import TYPE_CHECKING

from . import structs
from .base import pointer_to
from .library import library

if TYPE_CHECKING:
    from .base import Buffer


@dataclass
class MeshBuffers:
    """A triangle mesh in flat buffers of 4-byte items (array.array 'f', 'i' or 'I').

    positions [vertex][3], triangles [triangle][3]; normals and uvs belong to corners: entry
    corners[3 t + c] is that of corner c of triangle t (None: corners = triangles).
    """

    positions: array[float]
    triangles: array[int]
    corners: array[int] | None = None
    corner_normals: array[float] | None = None  # [corner][3]; None: flat shaded
    corner_uvs: array[float] | None = None  # [corner][2]
    corner_colors: array[float] | None = None  # [corner][4] linear RGBA, straight
    slots: array[int] | None = None  # [triangle]

    def struct(self) -> structs.MeshView:
        """Points into the buffers: keep them until the call is over. Raises ValueError when the
        lengths do not fit together, so that the library never reads past an end."""
        vertices = count("positions", self.positions, 3)
        triangles = count("triangles", self.triangles, 3)
        if self.corners is not None and count("corners", self.corners, 3) != triangles:
            raise ValueError("corners and triangles differ in length")
        counts = set()
        if self.corner_normals is not None:
            counts.add(count("corner_normals", self.corner_normals, 3))
        if self.corner_uvs is not None:
            counts.add(count("corner_uvs", self.corner_uvs, 2))
        if self.corner_colors is not None:
            counts.add(count("corner_colors", self.corner_colors, 4))
        if self.corners is None:
            counts.add(vertices)
        if len(counts) > 1:
            raise ValueError("normals, uvs and colors differ in their number of corners")
        if self.slots is not None and count("slots", self.slots, 1) != triangles:
            raise ValueError("slots and triangles differ in length")
        return structs.MeshView(
            positions=pointer_to(self.positions, c_float),
            vertex_count=vertices,
            triangles=pointer_to(self.triangles, c_uint32),
            triangle_count=triangles,
            corners=pointer_to(self.corners, c_uint32),
            corner_count=counts.pop() if counts else 0,
            corner_normals=pointer_to(self.corner_normals, c_float),
            corner_uvs=pointer_to(self.corner_uvs, c_float),
            corner_colors=pointer_to(self.corner_colors, c_float),
            slots=pointer_to(self.slots, c_int32),
        )


@dataclass
class FaceBuffers:
    """A mesh of polygons in flat buffers of 4-byte items; a corner is one vertex of one face. The
    library makes triangles and normals of it.

    positions [vertex][3], corner_vertices [corner]; those of a face follow each other, then those
    of the next face.
    """

    positions: Buffer
    corner_vertices: Buffer
    face_starts: Buffer | None = None  # [face] first corner; None: all faces are triangles
    triangles: Buffer | None = None  # [triangle][3] corners; None: no face has more than four
    face_smooth: Buffer | None = None  # [face], of 1-byte items; None: all flat
    face_slots: Buffer | None = None  # [face]
    corner_normals: Buffer | None = None  # [corner][3]; None: those of the faces
    corner_uvs: Buffer | None = None  # [corner][2]
    corner_colors: Buffer | None = None  # [corner][4] linear RGBA, straight
    vertex_colors: Buffer | None = None  # [vertex][4], where corner_colors is None

    @property
    def triangle_count(self) -> int:
        corners = len(self.corner_vertices)
        return corners // 3 if self.face_starts is None else corners - 2 * len(self.face_starts)

    def struct(self) -> structs.FacesView:
        """As MeshBuffers.struct()."""
        corners = count("corner_vertices", self.corner_vertices, 1)
        if self.face_starts is None:
            faces = count("corner_vertices", self.corner_vertices, 3)
        else:
            faces = count("face_starts", self.face_starts, 1)
        for name, width in (("corner_normals", 3), ("corner_uvs", 2), ("corner_colors", 4)):
            given = getattr(self, name)
            if given is not None and count(name, given, width) != corners:
                raise ValueError(f"{name} and corner_vertices differ in their number of corners")
        vertices = count("positions", self.positions, 3)
        colors = self.vertex_colors
        if colors is not None and count("vertex_colors", colors, 4) != vertices:
            raise ValueError("vertex_colors and positions differ in their number of vertices")
        if self.face_smooth is not None and count("face_smooth", self.face_smooth, 1, 1) != faces:
            raise ValueError("face_smooth has another number of faces")
        if self.face_slots is not None and count("face_slots", self.face_slots, 1) != faces:
            raise ValueError("face_slots has another number of faces")
        triangles = 0 if self.triangles is None else count("triangles", self.triangles, 3)
        return structs.FacesView(
            positions=pointer_to(self.positions, c_float),
            vertex_count=vertices,
            corner_vertices=pointer_to(self.corner_vertices, c_uint32),
            corner_count=corners,
            face_starts=pointer_to(self.face_starts, c_uint32),
            face_count=faces,
            triangles=pointer_to(self.triangles, c_uint32),
            triangle_count=triangles,
            face_smooth=pointer_to(self.face_smooth, c_uint8),
            face_slots=pointer_to(self.face_slots, c_int32),
            corner_normals=pointer_to(self.corner_normals, c_float),
            corner_uvs=pointer_to(self.corner_uvs, c_float),
            corner_colors=pointer_to(self.corner_colors, c_float),
            vertex_colors=pointer_to(colors, c_float),
        )


@dataclass
class StrandBuffers:
    """Hair or grass in flat buffers of 4-byte items: points [point][3] and radii [point] of all
    strands in a row, each strand's root first; counts [strand] points of each."""

    points: array[float]
    radii: array[float]
    counts: array[int]
    slots: array[int] | None = None  # [strand]
    uvs: array[float] | None = None  # [strand][2], of the surface at the root

    def struct(self) -> structs.StrandsView:
        """As MeshBuffers.struct()."""
        points = count("points", self.points, 3)
        strands = count("counts", self.counts, 1)
        if count("radii", self.radii, 1) != points:
            raise ValueError("points and radii differ in length")
        if self.slots is not None and count("slots", self.slots, 1) != strands:
            raise ValueError("slots and counts differ in length")
        if self.uvs is not None and count("uvs", self.uvs, 2) != strands:
            raise ValueError("uvs and counts differ in length")
        return structs.StrandsView(
            points=pointer_to(self.points, c_float),
            radii=pointer_to(self.radii, c_float),
            point_count=points,
            counts=pointer_to(self.counts, c_uint32),
            strand_count=strands,
            slots=pointer_to(self.slots, c_int32),
            uvs=pointer_to(self.uvs, c_float),
        )


def largest_face(face_starts: Buffer, corner_count: int) -> int:
    """The most corners that a face has: above four, FaceBuffers need triangles."""
    faces = count("face_starts", face_starts, 1)
    return library().lds_faces_largest(pointer_to(face_starts, c_uint32), faces, corner_count)


def count(name: str, buffer: Buffer, width: int, size: int = 4) -> int:
    if buffer.itemsize != size:
        raise ValueError(f"{name} needs {size}-byte items, not {buffer.itemsize}")
    if len(buffer) % width:
        raise ValueError(f"{name} has {len(buffer)} items, not a multiple of {width}")
    return len(buffer) // width
