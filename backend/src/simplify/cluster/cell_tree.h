// SPDX-License-Identifier: GPL-3.0-or-later
// Cell tree: the boxes of cells that are joined at a given number of cells; adaptive in detail.
#pragma once

#include "simplify/cluster/cell_grid.h"

#include <span>

namespace lodestone::simplify {

/// A binary tree over the cells: a node is a box of the grid, halved along one axis after the
/// other. Joining the nodes that cost least first leaves small cells where the surface bends and
/// large ones where it is flat. source: Schaefer & Warren 2003 (adaptive vertex clustering using
/// octrees), with the plane quadrics of Lindstrom 2000 (out-of-core simplification).
class CellTree {
public:
    explicit CellTree(const GridCells& cells);

    /// Joins nodes until `count` cells (from 1 to all) are left; returns the node that each cell is
    /// in now. Cells that stay alone have numbers below cells.count(); valid until the next call.
    std::span<const uint32_t> joined(size_t count);

    size_t nodes() const { return parent_.size(); }

private:
    ScratchVector<uint32_t> parent_;  // the parent of each cell, then of each node above
    /// The cost of joining a node above, never less than that of the nodes below it.
    ScratchVector<float> cost_;
    ScratchVector<float> order_;  // the same costs, partly sorted
    /// Places in order_ with smaller costs before and larger ones behind.
    ScratchVector<size_t> asked_;
    ScratchVector<uint32_t> node_;  // the node that each node is part of now
    size_t cells_;
};

}  // namespace lodestone::simplify
