// SPDX-License-Identifier: GPL-3.0-or-later
// Cell groups: which cells are joined so that a wanted number of triangles is left.
#pragma once

#include "simplify/cluster/cell_grid.h"

namespace lodestone::simplify {

/// Triangles of groups of cells, each once.
struct CellGroups {
    ScratchVector<uint32_t> group;      // of each cell
    ScratchVector<Triangle> triangles;  // of groups
    ScratchVector<uint32_t> sources;    // the mesh's triangle each was
    bool scattered = false;             // otherwise cells of a group follow each other
};

/// How the work is shared: the tree leaves `begin` cells for each one wanted, merging across the
/// grid's lines takes the rest away. Merging is better but dearer: it is given as much as fits into
/// a small part of the time that reading the mesh takes.
struct GroupingPlan {
    double begin = 1;
    bool merges = false;

    GroupingPlan(size_t triangles, size_t target);
};

/// Groups that leave at most `target` triangles, as near to it as a few tries come; more, where
/// fewer cells would leave none. Empty when the cells have no triangles.
CellGroups group_cells(const GridCells& cells, const GroupingPlan& plan, size_t target,
                       const Job& job);

}  // namespace lodestone::simplify
