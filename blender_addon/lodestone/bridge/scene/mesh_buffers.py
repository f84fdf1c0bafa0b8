# SPDX-License-Identifier: GPL-3.0-or-later
"""An evaluated Blender object's faces as flat buffers."""

from array import array
from collections.abc import Sequence
from typing import Any

import bmesh

from ...core.native import lodestone_native as native
from .. import blender_versions
from ..nodes.materials import Wanted
from . import mesh_colors, mesh_uvs


def extract(instance_object: Any, wanted: Sequence[Wanted], in_place: int = 0) -> Any:
    """FaceBuffers of an evaluated object (mesh, curve, text, surface, metaball), or None when it
    has no faces; `wanted` is what the material of each slot needs. Only while the object is valid:
    inside the loop over depsgraph instances. A mesh of no more corners than `in_place` is read
    where it is, if that can be: a copy takes longer to make than to read, but Blender gives the
    mesh arrays of its own then (some 12 bytes a corner), which last as long as the depsgraph."""
    if _holds_its_faces(instance_object) and len(instance_object.data.loops) <= in_place:
        starts = _face_starts(instance_object.data)
        if not _has_large_faces(instance_object.data, starts):
            return _buffers(instance_object.data, starts, instance_object, wanted)
    mesh = instance_object.to_mesh()
    try:
        if mesh is None:
            return None
        return _buffers(mesh, _face_starts(mesh), instance_object, wanted)
    finally:
        instance_object.to_mesh_clear()


def _holds_its_faces(shown: Any) -> bool:
    """Whether its mesh can be read where it is. Under edit it is no mesh yet, modifiers may leave
    it to the graphics card, and what is found of split normals (and of Blender's triangles) stays
    in it."""
    data = shown.data
    return (
        shown.type == "MESH"
        and not shown.modifiers
        and not data.is_editmode
        and not blender_versions.splits_normals(data)
    )


def _face_starts(mesh: Any) -> array | None:
    """The first corner of each face; None: all are triangles."""
    faces = len(mesh.polygons)
    if len(mesh.loops) == 3 * faces:
        return None
    starts = blender_versions.buffer("I", faces)
    mesh.polygons.foreach_get("loop_start", starts)
    return starts


def _has_large_faces(mesh: Any, starts: array | None) -> bool:
    """Whether a face has more than four corners."""
    return starts is not None and native.largest_face(starts, len(mesh.loops)) > 4


def _buffers(mesh: Any, starts: array | None, shown: Any, wanted: Sequence[Wanted]) -> Any:
    """Blender's triangles are asked for only where a face has more than four corners, and its
    normals only where they are others than those of the faces: both cost more than all the rest,
    and its sums of normals come out with other last digits each time."""
    faces, corners = len(mesh.polygons), len(mesh.loops)
    if faces == 0 or corners < 3:
        return None
    buffers = native.FaceBuffers(
        blender_versions.buffer("f", 3 * len(mesh.vertices)), blender_versions.buffer("I", corners)
    )
    mesh.vertices.foreach_get("co", buffers.positions)
    mesh.loops.foreach_get("vertex_index", buffers.corner_vertices)
    buffers.face_starts = starts
    if _has_large_faces(mesh, starts):
        buffers.triangles = _triangles(mesh)
    buffers.face_smooth = blender_versions.smooth_faces(mesh)
    if blender_versions.splits_normals(mesh) and (buffers.face_smooth or mesh.has_custom_normals):
        buffers.corner_normals = blender_versions.buffer("f", 3 * corners)
        blender_versions.corner_normals(mesh, buffers.corner_normals)
    if len(wanted) > 1:
        slots = blender_versions.buffer("i", faces)
        if blender_versions.face_slots(mesh, slots):
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
    triangles = blender_versions.buffer("I", 3 * len(mesh.loop_triangles))
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
