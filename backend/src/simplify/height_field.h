// SPDX-License-Identifier: GPL-3.0-or-later
// Height field: heights on a regular grid, found in a mesh and sub-sampled through a filter.
#pragma once

#include "base/job.h"
#include "model/mesh.h"

#include <optional>
#include <vector>

namespace lodestone::simplify {

/// A grid of columns x rows vertices over a rectangle of a coordinate plane; every cell is two
/// triangles.
struct HeightGrid {
    int across = 0;  // the axis along a row, 0...2; rows follow each other along `along`
    int along = 1;
    size_t columns = 0;
    size_t rows = 0;
    bool turned = false;           // the faces look against across x along
    std::vector<uint32_t> vertex;  // the mesh's vertices, row by row
};

/// The grid that the mesh is; none when vertices are off the grid (by a thousandth of its spacing),
/// split or left over, when cells are missing or not cut in two, or when there is more than one
/// slot.
std::optional<HeightGrid> find_grid(const Mesh& mesh);

/// A grid of at most `triangles` (at least 2) over the same rectangle, in about the same
/// proportion. Heights, texture coordinates and colors are those whose interpolation has the least
/// squared distance from the finer grid's: a weighted sum of all values around each sample (fine
/// detail does not alias), separable. Border lines depend on border lines alone and corners stay,
/// so that neighbors with the same samples still fit together. Normals, if there are any, are those
/// of the new surface. source: dissertation 3.3.1.
Mesh subsample(const Mesh& mesh, const HeightGrid& grid, size_t triangles, const Job& job = {});

}  // namespace lodestone::simplify
