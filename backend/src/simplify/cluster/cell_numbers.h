// SPDX-License-Identifier: GPL-3.0-or-later
// Cell numbers: the cell of a fine grid that each vertex lies in, along a space-filling curve.
#pragma once

#include "simplify/cluster/cell_grid.h"

#include <span>

namespace lodestone::simplify {

/// The map from metres into the frame.
class CellFrame {
public:
    /// `scale`: 1 / unit of the frame.
    CellFrame(const glm::vec3& low, double scale)
        : half_low_(four(low) * 0.5f), twice_(static_cast<float>(2 * scale)) {}
    /// Computes with halves, because differences of halves are floats in any case; the last number
    /// is 0.
    Four operator()(const glm::vec3& point) const {
        return (four(point) * 0.5f - half_low_) * twice_;
    }

private:
    Four half_low_;
    float twice_;
};

/// Sets `cell`, `split` and `step`; see divide_into_cells(). `positions` are in metres.
void number_cells(GridCells& cells, std::span<const glm::vec3> positions, const CellFrame& frame,
                  size_t least);

}  // namespace lodestone::simplify
