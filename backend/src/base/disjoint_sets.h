// SPDX-License-Identifier: GPL-3.0-or-later
// Disjoint sets: a partition of the numbers 0 ... n - 1, where `parents` starts as i for each i
// (union-find with path halving).
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace lodestone {

/// The lowest number of the set that `i` is in.
inline uint32_t root_of(std::vector<uint32_t>& parents, uint32_t i) {
    while (parents[i] != i) {
        parents[i] = parents[parents[i]];
        i = parents[i];
    }
    return i;
}

/// Makes one set of two; the result is the same in any order of joins.
inline void join(std::vector<uint32_t>& parents, uint32_t a, uint32_t b) {
    a = root_of(parents, a);
    b = root_of(parents, b);
    parents[std::max(a, b)] = std::min(a, b);
}

}  // namespace lodestone
