// SPDX-License-Identifier: GPL-3.0-or-later
// Cell merge: joins neighboring cells across the grid's lines, cheapest first.
#pragma once

#include "base/job.h"
#include "base/scratch.h"
#include "model/mesh.h"
#include "simplify/cluster/cell_quadric.h"

#include <span>

namespace lodestone::simplify {

/// Cells as the corners of triangles; any two corners of one are neighbors.
class CellMerge {
public:
    /// Keeps references to neither.
    CellMerge(std::span<const CellQuadric> quadrics, std::span<const Triangle> triangles);

    /// Merges until `count` are left or no neighbors are.
    void merge_to(size_t count, const Job& job);

    size_t count() const { return count_; }
    /// The cell that this one is part of now.
    uint32_t whole(uint32_t cell);
    const CellQuadric& quadric(uint32_t cell) const { return quadrics_[cell]; }

private:
    struct CellPair {
        float cost;
        uint32_t a, b;
        uint32_t merges;                           // of both when it was judged
        bool operator<(const CellPair& o) const {  // cheapest on top of a heap; ties by number
            if (cost != o.cost)
                return cost > o.cost;
            return a != o.a ? a > o.a : b > o.b;
        }
    };
    void judge(CellPair& pair) const;

    ScratchVector<CellQuadric> quadrics_;
    ScratchVector<float> least_;
    ScratchVector<uint32_t> part_of_;
    ScratchVector<uint32_t> merges_;
    ScratchVector<CellPair> pairs_;  // a heap
    size_t count_;
};

}  // namespace lodestone::simplify
