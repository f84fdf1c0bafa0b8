// SPDX-License-Identifier: GPL-3.0-or-later
// Edge costs: what collapsing costs for many edges at once, in the processor's vectors.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace lodestone::approximate {

/// As best_point and cost_at of quadric.h, in single precision. What is not filled in is arbitrary.
struct EdgeBlock {
    static constexpr size_t kSize = 64;
    /// Half the edge (b - a) / 2, the quadrics of a and of b, the difference b - a of the area
    /// vectors around them and their sum without the triangles on both, which end is held
    /// (-1: a, 1: b, 0: none).
    static constexpr size_t kInputs = 22;
    float in[kInputs][kSize];
    float cost[kSize];
};

void edge_costs(EdgeBlock& block);

/// Costs are never negative: their bits sort as they do. Above all of them:
inline constexpr uint32_t kImpossible = 0x7f800000;

inline uint32_t key_of_cost(float cost) {
    const auto key = std::bit_cast<uint32_t>(cost + 0.0f);  // of -0 that of 0
    return key < kImpossible ? key : kImpossible;
}

}  // namespace lodestone::approximate
