# SPDX-License-Identifier: GPL-3.0-or-later
"""An evaluated Blender object's faces as flat buffers."""

from array import array
from collections.abc import Sequence
from typing import Any

import bmesh

from . import compat, mesh_colors, mesh_uvs
from ..core.native import lodestone_native as native
from .materials import Wanted


def extract(instance_object: Any, wanted: Sequence[Wanted]) -> Any:
    """FaceBuffers of an evaluated object (mesh, curve, text, surface, metaball), or None when it
    has no faces; `wanted` is what the material of each slot needs. Only while the object is valid:
    inside the loop over depsgraph instances."""
    if _holds_its_faces(instance_object):
        return _buffers(instance_object.data, instance_object, wanted)
    mesh = instance_object.to_mesh()
    try:
        return None if mesh is None else _buffers(mesh, instance_object, wanted)
    finally:
        instance_object.to_mesh_clear()


def _holds_its_faces(shown: Any) -> bool:
    """Whether its mesh can be read where it is; what to_mesh() makes is a copy, which takes longer
    to make than to read. Under edit it is no mesh yet, modifiers may leave it to the graphics card,
    and finding split normals writes into it."""
    data = shown.data
    return (
        shown.type == "MESH"
        and not shown.modifiers
        and not data.is_editmode
        and not compat.splits_normals(data)
    )


def _buffers(mesh: Any, shown: Any, wanted: Sequence[Wanted]) -> Any:
    """Blender's triangles are asked for only where a face has more than four corners, and its
    normals only where they are others than those of the faces: both cost more than all the rest,
    and its sums of normals come out with other last digits each time."""
    polygons, corners = mesh.polygons, len(mesh.loops)
    faces = len(polygons)
    if faces == 0 or corners < 3:
        return None
    buffers = native.FaceBuffers(
        compat.buffer("f", 3 * len(mesh.vertices)), compat.buffer("I", corners)
    )
    mesh.vertices.foreach_get("co", buffers.positions)
    mesh.loops.foreach_get("vertex_index", buffers.corner_vertices)
    if corners != 3 * faces:
        buffers.face_starts = compat.buffer("I", faces)
        polygons.foreach_get("loop_start", buffers.face_starts)
        if native.largest_face(buffers.face_starts, corners) > 4:
            buffers.triangles = _triangles(mesh)
    buffers.face_smooth = compat.smooth_faces(mesh)
    if compat.splits_normals(mesh) and (buffers.face_smooth or mesh.has_custom_normals):
        buffers.corner_normals = compat.buffer("f", 3 * corners)
        compat.corner_normals(mesh, buffers.corner_normals)
    if len(wanted) > 1:
        slots = compat.buffer("i", faces)
        if compat.face_slots(mesh, slots):
            buffers.face_slots = slots
    if any(item.coordinates is not None for item in wanted):
        buffers.corner_uvs = mesh_uvs.corner_uvs(
            mesh, buffers, shown, [item.coordinates for item in wanted]
        )
    colors = [item.vertex_colors for item in wanted]
    if any(item is not None for item in colors):
        buffers.vertex_colors = mesh_colors.vertex_colors(mesh, colors)
        if buffers.vertex_colors is None:
            buffers.corner_colors = mesh_colors.corner_colors(mesh, colors)
    return buffers


def _triangles(mesh: Any) -> array:
    """The corners of Blender's triangles."""
    mesh.calc_loop_triangles()
    triangles = compat.buffer("I", 3 * len(mesh.loop_triangles))
    mesh.loop_triangles.foreach_get("loops", triangles)
    return triangles


def ball() -> Any:
    """MeshBuffers of a smooth ball of radius 1 in 320 triangles: POV-Ray draws its ellipsoid level
    as a true sphere."""
    made = bmesh.new()
    try:
        bmesh.ops.create_icosphere(made, subdivisions=3, radius=1.0)
        made.verts.index_update()
        points = array("f", (c for vertex in made.verts for c in vertex.co))
        triangles = array("i", (v.index for face in made.faces for v in face.verts))
    finally:
        made.free()
    return native.MeshBuffers(points, triangles, triangles, points)
