// SPDX-License-Identifier: GPL-3.0-or-later
// Vertex clustering: the fastest simplification; joins vertices that lie together, connected or
// not.
#pragma once

#include "base/job.h"
#include "model/mesh.h"

namespace lodestone::simplify {

/// The mesh with at most `triangles` (> 0). Vertices in the cells of a grid are joined where that
/// costs least, and the vertex of each cell lies where the squared distance to the planes of its
/// surface is least. Parts may grow together, holes and handles close, thin parts become one sheet:
/// for previews, and for meshes of millions of triangles. The result is never empty unless the
/// input is; among the joined triangles none occurs twice or has no area. Slots stay; normals, uvs
/// and colors, if there are any, are those of the surface in the cell, and seams stay seams. A
/// target not below the input's count returns the input. Any input is accepted; triangles with
/// non-finite vertices are left out. Throws Error(InvalidArgument) as check(mesh) does, or for a
/// target of 0. The same input gives the same bits. source: dissertation 3.3.6 (Rossignac & Borrel
/// 1993).
Mesh cluster_vertices(const Mesh& mesh, size_t triangles, const Job& job = {});

}  // namespace lodestone::simplify
