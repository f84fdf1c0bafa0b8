// SPDX-License-Identifier: GPL-3.0-or-later
// Disjoint sets of the numbers 0 ... n - 1: `parents` starts as i for each i.
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

/// Makes one set of two; the same in any order of joins.
inline void join(std::vector<uint32_t>& parents, uint32_t a, uint32_t b) {
    a = root_of(parents, a);
    b = root_of(parents, b);
    parents[std::max(a, b)] = std::min(a, b);
}

}  // namespace lodestone
