// SPDX-License-Identifier: GPL-3.0-or-later
// Neighbors: what edges a vertex has, and which triangles are on them.
#pragma once

#include "approximate/collapse_mesh.h"

#include <span>
#include <utility>
#include <vector>

namespace lodestone::approximate {

/// The corner of a triangle that is `vertex`.
inline int corner_of(const Triangle& t, uint32_t vertex) {
    return t.x == vertex ? 0 : (t.y == vertex ? 1 : 2);
}

/// The neighbors of one vertex after the other, and the triangles they share with it.
class Neighbors {
public:
    struct Neighbor {
        uint32_t vertex, uses, t0, t1;  // the first two triangles on it
        bool leaving0, leaving1;        // the triangle runs vertex -> neighbor
    };

    /// True when the triangles form closed fans, all turned alike: the usual case. Corner i of them
    /// is then shared by triangles i and before(i) of the ring, of which it is last.
    bool find_fan(const CollapseMesh& mesh, std::span<const uint32_t> ring, uint32_t vertex) {
        const auto count = static_cast<uint32_t>(ring.size());
        if (count > kMost)
            return false;
        uint32_t from[kMost];
        for (uint32_t i = 0; i < count; ++i) {
            const Triangle& t = mesh.triangles[ring[i]];
            const bool first = t.x == vertex;
            const bool second = t.y == vertex;
            to_[i] = first ? t.y : (second ? t.z : t.x);
            from[i] = first ? t.z : (second ? t.x : t.y);
            slots_[from[i] % kSlots] = static_cast<uint8_t>(i);
        }
        uint32_t met = 0;
        bool fits = true;
        for (uint32_t i = 0; i < count; ++i) {
            const uint32_t at = slots_[to_[i] % kSlots] % kMost;
            fits &= at < count && from[at] == to_[i];
            met |= 1u << at;
            before_[i] = at;
        }
        return fits && met == (1u << count) - 1;
    }
    uint32_t corner(uint32_t i) const { return to_[i]; }
    uint32_t before(uint32_t i) const { return before_[i]; }

    /// Of any vertex; `fan`: as find_fan() has just found.
    std::span<const Neighbor> find(const CollapseMesh& mesh, std::span<const uint32_t> ring,
                                   uint32_t vertex, bool fan);

private:
    static constexpr uint32_t kMost = 16;

    void find_any(const CollapseMesh& mesh, std::span<const uint32_t> ring, uint32_t vertex);

    // Where in the fan a neighbor is, by its lowest bits.
    static constexpr uint32_t kSlots = 1024;
    uint8_t slots_[kSlots] = {};
    uint32_t to_[kMost] = {};
    uint32_t before_[kMost] = {};
    std::vector<Neighbor> found_;
    std::vector<std::pair<uint32_t, size_t>> uses_;
};

}  // namespace lodestone::approximate
