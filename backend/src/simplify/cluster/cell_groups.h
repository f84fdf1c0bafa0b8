// SPDX-License-Identifier: GPL-3.0-or-later
// Cell groups: the cells that are joined so that a wanted number of triangles is left.
#pragma once

#include "simplify/cluster/cell_grid.h"

namespace lodestone::simplify {

/// Groups of cells, and the triangles between them, each once.
struct CellGroups {
    ScratchVector<uint32_t> group;      // the group of each cell
    ScratchVector<Triangle> triangles;  // between groups
    ScratchVector<uint32_t> sources;    // the mesh's triangle that each was
    bool scattered = false;             // false: the cells of a group follow each other
};

/// How the work is shared: the tree leaves `begin` cells for each one that is wanted, and merging
/// across the grid's lines removes the others. Merging gives less error but takes longer: it gets
/// as much time as a small part of the time that reading the mesh takes.
struct GroupingPlan {
    double begin = 1;
    bool merges = false;

    GroupingPlan(size_t triangles, size_t target);
};

/// Finds groups that leave at most `target` triangles, as near to it as a few tries come; more,
/// where fewer cells would leave none. Empty when the cells have no triangles.
CellGroups group_cells(const GridCells& cells, const GroupingPlan& plan, size_t target,
                       const Job& job);

}  // namespace lodestone::simplify
