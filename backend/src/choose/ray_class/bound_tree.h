// SPDX-License-Identifier: GPL-3.0-or-later
// Bound tree: the distance from a thing to the nearest other thing.
#pragma once

#include "base/maths.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace lodestone::choose {

/// A lower bound of the distance of two things, from their boxes and their spheres; 0 where these
/// touch.
double distance(const Bound& a, const Bound& b);

class BoundTree {
public:
    /// Empty bounds are left out. cost: n log n.
    explicit BoundTree(std::vector<Bound> bounds);

    /// The least distance to any bound except the one numbered `but`, or `most` if that is less.
    /// Thread-safe. cost: about log n where few are near.
    double nearest(const Bound& from, uint32_t but, double most) const {
        return nearest(from, but, most, [](const Bound&) { return true; });
    }
    /// The same among those for which counts(bound) holds.
    double nearest(const Bound& from, uint32_t but, double most,
                   const std::function<bool(const Bound&)>& counts) const;

private:
    struct BoundTreeNode {
        Box3 box;
        /// In order_; for an inner node: the index of its first child, the other follows it.
        uint32_t first = 0;
        uint32_t count = 0;  // 0: an inner node
    };
    void build(uint32_t part, uint32_t first, uint32_t count);

    std::vector<Bound> bounds_;
    std::vector<uint32_t> order_;
    std::vector<BoundTreeNode> parts_;
};

}  // namespace lodestone::choose
