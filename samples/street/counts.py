# SPDX-License-Identifier: GPL-3.0-or-later
"""Counts: what the dependency graph holds, as a renderer meets it."""


def count(depsgraph):
    """Objects of the scene, mesh instances, unique and placed triangles."""
    triangles = {}
    result = {"instances": 0, "unique_triangles": 0, "placed_triangles": 0}
    for instance in depsgraph.object_instances:
        obj = instance.object
        if obj.type != "MESH":
            continue
        mesh = obj.data
        key = mesh.name_full
        if key not in triangles:
            triangles[key] = len(mesh.loops) - 2 * len(mesh.polygons)
        result["instances"] += 1
        result["placed_triangles"] += triangles[key]
    result["unique_triangles"] = sum(triangles.values())
    result["meshes"] = len(triangles)
    result["objects"] = len(depsgraph.scene.objects)
    return result
