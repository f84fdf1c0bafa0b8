// SPDX-License-Identifier: GPL-3.0-or-later
// Grid: height fields on a regular grid, found in a mesh and sub-sampled through a filter.
#pragma once

#include "base/job.h"
#include "model/mesh.h"

#include <optional>
#include <vector>

namespace lodestone::simplify {

/// columns x rows vertices over a rectangle of a coordinate plane, every cell two triangles.
struct HeightGrid {
    int across = 0;  // the axis along a row, 0...2; rows follow each other along `along`
    int along = 1;
    size_t columns = 0;
    size_t rows = 0;
    bool turned = false;           // the faces look against across x along
    std::vector<uint32_t> vertex;  // of the mesh, row by row
};

/// The grid that the mesh is; nothing when it is none: vertices off the grid (by a thousandth of
/// its spacing), split, or left over, cells that are missing or not cut in two, more than one slot.
std::optional<HeightGrid> find_grid(const Mesh& mesh);

/// A grid of at most `triangles` (at least 2) over the same rectangle, in about the same
/// proportion. Heights, texture coordinates and colors are those whose interpolation has the least
/// squared distance from the finer grid's: a weighted sum of all around each sample (fine detail
/// does not alias), separable. Border lines depend on border lines alone and corners stay, so that
/// equally sampled neighbors go on fitting. Normals, if there are any, are the new surface's.
/// source: dissertation 3.3.1.
Mesh subsample(const Mesh& mesh, const HeightGrid& grid, size_t triangles, const Job& job = {});

}  // namespace lodestone::simplify
