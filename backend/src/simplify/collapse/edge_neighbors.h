// SPDX-License-Identifier: GPL-3.0-or-later
// Edge neighbors: the edges of a vertex, and the triangles on them.
#pragma once

#include "simplify/collapse/collapse_mesh.h"

#include <algorithm>
#include <bit>
#include <span>
#include <utility>
#include <vector>

namespace lodestone::simplify {

/// The corner of a triangle at which `vertex` lies.
inline int corner_of(const Triangle& t, uint32_t vertex) {
    return t.x == vertex ? 0 : (t.y == vertex ? 1 : 2);
}

/// The corners of a triangle that follow the one at `vertex`: the next and the last. There are no
/// branches, because nobody can predict which corner it is.
struct CornerEnds {
    uint32_t at, next, last;
};
inline CornerEnds ends_of(const Triangle& t, uint32_t vertex) {
    const uint32_t* corners = &t.x;
    const uint32_t at = static_cast<uint32_t>(t.y == vertex) + 2 * uint32_t{t.z == vertex};
    // The next corners of 0, 1, 2 are 1, 2, 0 and the last ones 2, 0, 1: two bits each.
    return {at, corners[0x09u >> 2 * at & 3u], corners[0x12u >> 2 * at & 3u]};
}

/// Finds the neighbors of one vertex after the other, and the triangles they share with it.
class VertexNeighbors {
public:
    struct NeighborEdge {
        uint32_t vertex, uses, t0, t1;  // the first two triangles on it
        bool leaving0, leaving1;        // the triangle runs from the vertex to the neighbor
    };

    /// The fan of triangles around a vertex, if all are turned alike. Closed: one fan or several,
    /// each around the whole vertex. Open: one that begins and ends on a border. These are the
    /// usual cases.
    enum class FanKind : uint8_t { None, Closed, Open };
    FanKind find_fan(const CollapseMesh& mesh, std::span<const uint32_t> ring, uint32_t vertex) {
        const auto count = static_cast<uint32_t>(ring.size());
        if (count > kMost || count == 0)
            return FanKind::None;
        for (uint32_t i = 0; i < count; ++i) {
            const CornerEnds ends = ends_of(mesh.triangles[ring[i]], vertex);
            to_[i] = ends.next;
            from_[i] = ends.last;
            slots_[ends.last % kSlots] = static_cast<uint8_t>(i);
        }
        uint32_t met = 0;
        uint32_t starts = 0;
        begin_ = end_ = 0;
        open_ = false;
        for (uint32_t i = 0; i < count; ++i) {
            const uint32_t at = slots_[to_[i] % kSlots] % kMost;
            const bool fits = at < count && from_[at] == to_[i];
            met |= uint32_t{fits} << at;
            starts += !fits;
            begin_ = fits ? begin_ : i;
            before_[i] = at;
        }
        const uint32_t all = (1u << count) - 1;
        if (starts == 0)
            return met == all ? FanKind::Closed : FanKind::None;
        if (starts > 1 || !std::has_single_bit(all ^ met))
            return FanKind::None;
        end_ = static_cast<uint32_t>(std::countr_zero(all ^ met));
        if (to_[begin_] == from_[end_]) {  // whose slot another neighbor has taken
            before_[begin_] = end_;
            begin_ = end_;
            return FanKind::Closed;
        }
        open_ = true;
        return FanKind::Open;
    }

    /// After find_fan() has found a fan: orders the ring so that the corner `next` of each triangle
    /// is the corner `last` of the one before it; a closed fan begins anywhere. False, and nothing
    /// done, for several fans.
    bool order(std::span<uint32_t> ring) const {
        const auto count = static_cast<uint32_t>(ring.size());
        uint32_t ordered[kMost];
        uint32_t at = end_;
        for (uint32_t i = count; i-- > 0; at = before_[at]) {
            // The start of a closed fan is reached, or that of an open one, too early.
            if (at == begin_ && (open_ ? i > 0 : i + 1 < count))
                return false;
            ordered[i] = ring[at];
        }
        std::copy(ordered, ordered + count, ring.begin());
        return true;
    }

    /// After find_fan() has found a fan: whether it is only one. `count`: the triangles of the
    /// ring.
    bool is_one(size_t count) const {
        uint32_t at = end_;
        for (size_t i = 1; i < count; ++i) {
            if (open_ && at == begin_)
                return false;
            at = before_[at];
            if (!open_ && at == end_)
                return false;
        }
        return true;
    }

    /// The neighbors across the two borders of an open fan, by the triangles on them.
    uint32_t first_corner() const { return to_[begin_]; }
    uint32_t last_corner() const { return from_[end_]; }

    /// The neighbors of any vertex; `fan`: the result of find_fan() for it.
    std::span<const NeighborEdge> find(const CollapseMesh& mesh, std::span<const uint32_t> ring,
                                       uint32_t vertex, FanKind fan);

private:
    /// The most triangles of a fan.
    /// Taste: a larger number finds more fans and makes every vertex slower.
    static constexpr uint32_t kMost = 16;

    bool find_in_open_fan(std::span<const uint32_t> ring);
    void find_any(const CollapseMesh& mesh, std::span<const uint32_t> ring, uint32_t vertex);

    // The place of a neighbor in the fan, by the lowest bits of its number.
    // Taste: more slots mix up fewer neighbors and take more of the cache.
    static constexpr uint32_t kSlots = 1024;
    uint8_t slots_[kSlots] = {};
    uint32_t to_[kMost] = {};
    uint32_t from_[kMost] = {};
    uint32_t before_[kMost] = {};
    uint32_t begin_ = 0;
    uint32_t end_ = 0;
    bool open_ = false;
    std::vector<NeighborEdge> found_;
    std::vector<std::pair<uint32_t, size_t>> uses_;
};

}  // namespace lodestone::simplify
