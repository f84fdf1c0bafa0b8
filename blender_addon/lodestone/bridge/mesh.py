# SPDX-License-Identifier: GPL-3.0-or-later
"""An evaluated Blender object's triangles as flat buffers."""

from array import array
from typing import Any

import bmesh

from . import compat
from ..core.native import lodestone_native as native


def _buffer(code: str, count: int) -> array:
    return array(code, bytes(4 * count))


def extract(instance_object: Any, slot_count: int, with_uvs: bool) -> Any:
    """MeshBuffers of an evaluated object (mesh, curve, text, surface, metaball), or None when it
    has no faces. Only while the object is valid: inside the loop over depsgraph instances."""
    mesh = instance_object.to_mesh()
    try:
        return None if mesh is None else _buffers(mesh, slot_count, with_uvs)
    finally:
        instance_object.to_mesh_clear()


def _buffers(mesh: Any, slot_count: int, with_uvs: bool) -> Any:
    if not mesh.polygons:
        return None
    mesh.calc_loop_triangles()
    vertices, corners, triangles = len(mesh.vertices), len(mesh.loops), len(mesh.loop_triangles)
    if triangles == 0:
        return None
    buffers = native.MeshBuffers(_buffer("f", 3 * vertices), _buffer("i", 3 * triangles))
    mesh.vertices.foreach_get("co", buffers.positions)
    mesh.loop_triangles.foreach_get("vertices", buffers.triangles)
    uv_layer = next((layer for layer in mesh.uv_layers if layer.active_render), None)
    if _has_smooth(mesh):
        buffers.corner_normals = _buffer("f", 3 * corners)
        compat.corner_normals(mesh, buffers.corner_normals)
    if with_uvs and uv_layer is not None:
        buffers.corner_uvs = _buffer("f", 2 * corners)
        compat.corner_uvs(uv_layer, buffers.corner_uvs)
    if buffers.corner_normals is not None or buffers.corner_uvs is not None:
        buffers.corners = _buffer("i", 3 * triangles)
        mesh.loop_triangles.foreach_get("loops", buffers.corners)
    if slot_count > 1:
        buffers.slots = _buffer("i", triangles)
        mesh.loop_triangles.foreach_get("material_index", buffers.slots)
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
