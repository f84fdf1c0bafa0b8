# SPDX-License-Identifier: GPL-3.0-or-later
"""An evaluated Blender object's triangles as flat buffers."""

from array import array
from collections.abc import Sequence
from typing import Any

import bmesh

from . import compat, mesh_colors, mesh_uvs
from ..core.native import lodestone_native as native
from .materials import Wanted


def extract(instance_object: Any, wanted: Sequence[Wanted]) -> Any:
    """MeshBuffers of an evaluated object (mesh, curve, text, surface, metaball), or None when it
    has no faces; `wanted` is what the material of each slot needs. Only while the object is valid:
    inside the loop over depsgraph instances."""
    mesh = instance_object.to_mesh()
    try:
        return None if mesh is None else _buffers(mesh, instance_object, wanted)
    finally:
        instance_object.to_mesh_clear()


def _buffers(mesh: Any, shown: Any, wanted: Sequence[Wanted]) -> Any:
    if not mesh.polygons:
        return None
    mesh.calc_loop_triangles()
    vertices, corners, triangles = len(mesh.vertices), len(mesh.loops), len(mesh.loop_triangles)
    if triangles == 0:
        return None
    buffers = native.MeshBuffers(
        compat.buffer("f", 3 * vertices), compat.buffer("i", 3 * triangles)
    )
    mesh.vertices.foreach_get("co", buffers.positions)
    mesh.loop_triangles.foreach_get("vertices", buffers.triangles)
    if _has_smooth(mesh):
        buffers.corner_normals = compat.buffer("f", 3 * corners)
        compat.corner_normals(mesh, buffers.corner_normals)
    if len(wanted) > 1:
        buffers.slots = compat.buffer("i", triangles)
        mesh.loop_triangles.foreach_get("material_index", buffers.slots)
    textured = any(item.coordinates is not None for item in wanted)
    colored = any(item.vertex_colors is not None for item in wanted)
    if buffers.corner_normals is not None or textured or colored:
        buffers.corners = compat.buffer("i", 3 * triangles)
        mesh.loop_triangles.foreach_get("loops", buffers.corners)
    if textured:
        buffers.corner_uvs = mesh_uvs.corner_uvs(
            mesh, buffers, shown, [item.coordinates for item in wanted]
        )
    if colored:
        buffers.corner_colors = mesh_colors.corner_colors(
            mesh, [item.vertex_colors for item in wanted]
        )
    return buffers


def _has_smooth(mesh: Any) -> bool:
    if mesh.has_custom_normals:
        return True
    smooth = array("b", bytes(len(mesh.polygons)))
    mesh.polygons.foreach_get("use_smooth", smooth)
    return 1 in smooth


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
