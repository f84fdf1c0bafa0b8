// SPDX-License-Identifier: GPL-3.0-or-later
// Cells: the vertices of a mesh in the cells of a fine grid, each cell with its quadric.
#pragma once

#include "base/job.h"
#include "base/scratch.h"
#include "model/mesh.h"
#include "simplify/cluster/cell_quadric.h"

#include <glm/common.hpp>

#include <limits>
#include <span>

namespace lodestone::simplify {

constexpr uint32_t kNoCell = ~uint32_t{0};

/// The cells that hold vertices, in the order of a space-filling curve (Morton's). Positions are in
/// a frame whose unit is the mesh's largest extent.
struct GridCells {
    glm::dvec3 low{0.0};           // origin of the frame, metres
    double unit = 0;               // metres; 0: the mesh has no extent, and there are no cells
    float step = 0;                // the longest side of a cell's box, in the frame
    ScratchVector<uint32_t> cell;  // of each vertex
    ScratchVector<CellQuadric> quadrics;  // of each cell
    ScratchVector<uint8_t> split;  // the highest bit in which its code and the next one's differ
    ScratchVector<Triangle> triangles;  // of cells, where the three differ
    ScratchVector<uint32_t> sources;    // the mesh's triangle each of them was

    size_t count() const { return quadrics.size(); }
    glm::vec3 metres(const glm::vec3& p) const {
        constexpr double kMost = std::numeric_limits<float>::max();
        return glm::vec3(glm::clamp(glm::dvec3(p) * unit + low, -kMost, kMost));
    }
};

/// Where points lie, in metres, if all are finite.
struct PointExtent {
    glm::vec3 low{0.0f}, high{0.0f};
    bool finite = true;
};

PointExtent extent_of(std::span<const glm::vec3> points);

/// At least `least` cells, if there are as many vertices and the grid can tell them apart: it has
/// 2^10 steps a side, 2^20 for more than a million vertices. `extent` is that of the
/// vertices, which must be finite.
GridCells divide_into_cells(const Mesh& mesh, const PointExtent& extent, size_t least,
                            const Job& job);

}  // namespace lodestone::simplify
