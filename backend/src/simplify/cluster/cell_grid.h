// SPDX-License-Identifier: GPL-3.0-or-later
// Cell grid: the vertices of a mesh in the cells of a fine grid, each cell with its quadric.
#pragma once

#include "base/job.h"
#include "base/scratch.h"
#include "model/mesh.h"
#include "simplify/cluster/cell_quadric.h"

#include <glm/common.hpp>

#include <limits>
#include <span>

namespace lodestone::simplify {

/// The cell of a vertex that lies in none.
constexpr uint32_t kNoCell = ~uint32_t{0};

/// The cells that hold vertices, in the order of a space-filling curve (Morton order). Positions
/// are in a frame whose unit is the largest extent of the mesh.
struct GridCells {
    glm::dvec3 low{0.0};           // the origin of the frame, in metres
    double unit = 0;               // in metres; 0: the mesh has no extent, and there are no cells
    float step = 0;                // the longest side of a cell's box, in the frame
    ScratchVector<uint32_t> cell;  // the cell of each vertex
    ScratchVector<CellQuadric> quadrics;  // the quadric of each cell
    /// The highest bit that differs between its code and the next one's.
    ScratchVector<uint8_t> split;
    ScratchVector<Triangle> triangles;  // between cells, where the three differ
    ScratchVector<uint32_t> sources;    // the mesh's triangle that each of them was

    size_t count() const { return quadrics.size(); }
    glm::vec3 metres(const glm::vec3& p) const {
        constexpr double kMost = std::numeric_limits<float>::max();
        return glm::vec3(glm::clamp(glm::dvec3(p) * unit + low, -kMost, kMost));
    }
};

/// The box around points, in metres, if all are finite.
struct PointExtent {
    glm::vec3 low{0.0f}, high{0.0f};
    bool finite = true;
};

PointExtent extent_of(std::span<const glm::vec3> points);

/// Makes at least `least` cells, if there are as many vertices and the grid can tell them apart: it
/// has 2^10 steps a side, 2^20 for more than a million vertices. `extent`: that of the vertices,
/// which must be finite.
GridCells divide_into_cells(const Mesh& mesh, const PointExtent& extent, size_t least,
                            const Job& job);

}  // namespace lodestone::simplify
