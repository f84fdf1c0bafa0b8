// SPDX-License-Identifier: GPL-3.0-or-later
// Cell merge: joins neighboring cells across the grid's lines, cheapest first.
#pragma once

#include "base/job.h"
#include "base/scratch.h"
#include "model/mesh.h"
#include "simplify/cluster/cell_quadric.h"

#include <span>

namespace lodestone::simplify {

/// The cells as the corners of triangles; any two corners of a triangle are neighbors.
class CellMerge {
public:
    /// Copies what it needs of both.
    CellMerge(std::span<const CellQuadric> quadrics, std::span<const Triangle> triangles);

    /// Merges until `count` cells are left or no two are neighbors.
    void merge_to(size_t count, const Job& job);

    size_t count() const { return count_; }
    /// The cell that this one is part of now.
    uint32_t whole(uint32_t cell);
    const CellQuadric& quadric(uint32_t cell) const { return quadrics_[cell]; }

private:
    struct CellPair {
        float cost;
        uint32_t a, b;
        uint32_t merges;  // the merges of both when the pair was judged
        /// Puts the cheapest on top of a heap; equal costs go by number.
        bool operator<(const CellPair& o) const {
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
