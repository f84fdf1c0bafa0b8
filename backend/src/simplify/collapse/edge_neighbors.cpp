// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/collapse/edge_neighbors.h"

#include <algorithm>

namespace lodestone::simplify {

std::span<const VertexNeighbors::NeighborEdge> VertexNeighbors::find(const CollapseMesh& mesh,
                                                                     std::span<const uint32_t> ring,
                                                                     uint32_t vertex, FanKind fan) {
    found_.clear();
    if (fan == FanKind::Closed) {
        for (uint32_t i = 0; i < ring.size(); ++i)
            found_.push_back({to_[i], 2, ring[i], ring[before_[i]], true, false});
    } else if (fan != FanKind::Open || !find_in_open_fan(ring)) {
        find_any(mesh, ring, vertex);
    }
    return found_;
}

/// Finds the edges in the order in which find_any() does. False, and nothing done, where an edge on
/// its border has another triangle.
bool VertexNeighbors::find_in_open_fan(std::span<const uint32_t> ring) {
    const auto count = static_cast<uint32_t>(ring.size());
    uint32_t after[kMost]{};
    uint32_t met = 0;
    for (uint32_t i = 0; i < count; ++i) {
        met += (to_[i] == to_[begin_]) + (from_[i] == to_[begin_]);
        met += (to_[i] == from_[end_]) + (from_[i] == from_[end_]);
        if (i != begin_)
            after[before_[i]] = i;
    }
    if (met != 2)
        return false;
    for (uint32_t i = 0; i < count; ++i) {
        if (i == begin_)
            found_.push_back({to_[i], 1, ring[i], kNone, true, false});
        else if (before_[i] > i)
            found_.push_back({to_[i], 2, ring[i], ring[before_[i]], true, false});
        if (i == end_)
            found_.push_back({from_[i], 1, ring[i], kNone, false, false});
        else if (after[i] > i)
            found_.push_back({from_[i], 2, ring[i], ring[after[i]], false, true});
    }
    return true;
}

void VertexNeighbors::find_any(const CollapseMesh& mesh, std::span<const uint32_t> ring,
                               uint32_t vertex) {
    // The most triangles whose neighbors are searched one by one.
    // Taste: sorting is faster for larger hubs only.
    constexpr size_t kFew = 64;
    const size_t end = 2 * ring.size();
    const auto other_end = [&](size_t i) {
        const Triangle& corners = mesh.triangles[ring[i / 2]];
        return corners[(corner_of(corners, vertex) + 1 + static_cast<int>(i & 1u)) % 3];
    };
    // Pairs (neighbor, index of its use): those of hubs are sorted, all others searched.
    uses_.clear();
    if (end > kFew) {
        for (size_t i = 0; i < end; ++i)
            uses_.emplace_back(other_end(i), i);
        std::sort(uses_.begin(), uses_.end());
    }
    for (size_t n = 0; n < end; ++n) {
        const size_t i = uses_.empty() ? n : uses_[n].second;
        const uint32_t other = other_end(i);
        const uint32_t t = ring[i / 2];
        const bool leaving = (i & 1u) == 0;
        NeighborEdge* known = nullptr;
        if (!uses_.empty()) {
            if (!found_.empty() && found_.back().vertex == other)
                known = &found_.back();
        } else {
            for (NeighborEdge& each : found_) {
                if (each.vertex == other)
                    known = &each;
            }
        }
        if (known == nullptr) {
            found_.push_back({other, 1, t, kNone, leaving, false});
        } else if (++known->uses == 2) {
            known->t1 = t;
            known->leaving1 = leaving;
        }
    }
}

}  // namespace lodestone::simplify
