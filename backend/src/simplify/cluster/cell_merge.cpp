// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/cluster/cell_merge.h"

#include <algorithm>

namespace lodestone::simplify {
namespace {

/// Every edge of the triangles once, in the order of their first appearance.
ScratchVector<std::pair<uint32_t, uint32_t>> edges_of(std::span<const Triangle> triangles) {
    size_t size = 64;                    // two triangles for each edge: half full
    while (size < triangles.size() * 3)  // two triangles an edge: half full
        size *= 2;
    // Law: no edge joins 0 to 0, so this key is free.
    constexpr uint64_t kFree = 0;
    ScratchVector<uint64_t> table(size, kFree);
    ScratchVector<std::pair<uint32_t, uint32_t>> edges;
    edges.reserve(triangles.size() * 2);
    for (const Triangle& t : triangles) {
        for (int i = 0; i < 3; ++i) {
            const uint32_t a = std::min(t[i], t[(i + 1) % 3]);
            const uint32_t b = std::max(t[i], t[(i + 1) % 3]);
            const uint64_t key = uint64_t{b} << 32u | a;
            size_t at = (key * 0x9e3779b97f4a7c15u >> 20u) & (size - 1);
            while (table[at] != kFree && table[at] != key)
                at = (at + 1) & (size - 1);
            if (table[at] == key)
                continue;
            table[at] = key;
            edges.emplace_back(a, b);
        }
    }
    return edges;
}

}  // namespace

CellMerge::CellMerge(std::span<const CellQuadric> quadrics, std::span<const Triangle> triangles)
    : quadrics_(quadrics.begin(), quadrics.end()),
      least_(quadrics.size()),
      part_of_(quadrics.size()),
      merges_(quadrics.size(), 0),
      count_(quadrics.size()) {
    for (uint32_t i = 0; i < quadrics.size(); ++i) {
        part_of_[i] = i;
        least_[i] = quadrics[i].c() > 0 ? quadrics[i].least() : 0;
    }
    const auto edges = edges_of(triangles);
    pairs_.reserve(edges.size());
    for (const auto& [a, b] : edges) {
        CellPair pair{0, a, b, 0};
        judge(pair);
        pairs_.push_back(pair);
    }
    std::make_heap(pairs_.begin(), pairs_.end());
}

void CellMerge::judge(CellPair& pair) const {
    CellQuadric sum = quadrics_[pair.a];
    sum.add(quadrics_[pair.b]);
    pair.cost = std::max(0.0f, sum.least() - least_[pair.a] - least_[pair.b]);
    pair.merges = merges_[pair.a] + merges_[pair.b];
}

uint32_t CellMerge::whole(uint32_t cell) {
    while (part_of_[cell] != cell) {
        part_of_[cell] = part_of_[part_of_[cell]];
        cell = part_of_[cell];
    }
    return cell;
}

void CellMerge::merge_to(size_t count, const Job& job) {
    for (size_t step = 0; count_ > count && !pairs_.empty(); ++step) {
        if ((step & 0xfffu) == 0)
            job.check();
        std::pop_heap(pairs_.begin(), pairs_.end());
        CellPair pair = pairs_.back();
        pair.a = whole(pair.a);
        pair.b = whole(pair.b);
        if (pair.a == pair.b) {
            pairs_.pop_back();
            continue;
        }
        // One of the two has grown since, so the pair costs more.
        if (merges_[pair.a] + merges_[pair.b] != pair.merges) {
            judge(pair);
            pairs_.back() = pair;
            std::push_heap(pairs_.begin(), pairs_.end());
            continue;
        }
        pairs_.pop_back();
        quadrics_[pair.a].add(quadrics_[pair.b]);
        least_[pair.a] += least_[pair.b] + pair.cost;
        merges_[pair.a] += merges_[pair.b] + 1;
        part_of_[pair.b] = pair.a;
        --count_;
    }
}

}  // namespace lodestone::simplify
