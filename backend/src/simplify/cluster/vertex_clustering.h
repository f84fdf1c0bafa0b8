// SPDX-License-Identifier: GPL-3.0-or-later
// Clustering: the fastest simplification; joins what lies together, whatever it is connected to.
#pragma once

#include "base/job.h"
#include "model/mesh.h"

namespace lodestone::simplify {

/// The mesh with at most `triangles` (> 0): vertices of a grid's cells joined where that costs
/// least, each cell's vertex where the squared distance to the planes of its surface is least.
/// Parts may grow together, holes and handles close, thin parts become one sheet: for previews, and
/// for meshes of millions of triangles. Never empty unless the input is; of the triangles that were
/// joined none is there twice or without area. Slots stay; normals, uvs and colors, if there are
/// any, are those of the surface that went into the cell, and seams stay seams. A target not below
/// the input's count returns the input. Any input is accepted; triangles with non-finite vertices
/// are left out. Throws Error(InvalidArgument) as check(mesh) does, or for a target of 0. Same
/// input, same bits. source: dissertation 3.3.6 (Rossignac & Borrel 1993).
Mesh cluster_vertices(const Mesh& mesh, size_t triangles, const Job& job = {});

}  // namespace lodestone::simplify
