// SPDX-License-Identifier: GPL-3.0-or-later
// Bound tree: how near anything is to something.
#pragma once

#include "base/maths.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace lodestone::choose {

/// At least so far apart are two things, by their boxes and by their spheres; 0 where these touch.
double distance(const Bound& a, const Bound& b);

class BoundTree {
public:
    /// Empty ones are left out. cost: n log n.
    explicit BoundTree(std::vector<Bound> bounds);

    /// The least distance to any but the one of that number, or `most` if that is less.
    /// Thread-safe. cost: about log n where few are near.
    double nearest(const Bound& from, uint32_t but, double most) const {
        return nearest(from, but, most, [](const Bound&) { return true; });
    }
    /// The same of those that counts(bound) holds for.
    double nearest(const Bound& from, uint32_t but, double most,
                   const std::function<bool(const Bound&)>& counts) const;

private:
    struct BoundTreeNode {
        Box3 box;
        uint32_t first = 0;  // of order_; inner: index of its first child, the other follows it
        uint32_t count = 0;  // 0: inner
    };
    void build(uint32_t part, uint32_t first, uint32_t count);

    std::vector<Bound> bounds_;
    std::vector<uint32_t> order_;
    std::vector<BoundTreeNode> parts_;
};

}  // namespace lodestone::choose
