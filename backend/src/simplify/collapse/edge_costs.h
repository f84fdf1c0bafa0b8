// SPDX-License-Identifier: GPL-3.0-or-later
// Edge costs: the costs of collapsing many edges at once, in the processor's vectors.
#pragma once

#include "base/maths.h"

#include <bit>
#include <cstddef>
#include <cstdint>

namespace lodestone::simplify {

/// The surroundings of a vertex: its position, the sum of the area vectors around it, its quadric.
struct VertexAround {
    glm::vec3 point{0.0f};
    glm::vec3 facet{0.0f};
    float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
};

/// The two ends of an edge, the sum of the area vectors of the triangles on it, and which end is
/// held (-1: a, 1: b, 0: none).
struct EdgeInput {
    const VertexAround* a;
    const VertexAround* b;
    glm::vec3 shared{0.0f};
    float held = 0;
};

/// The edges of one call, with the results of optimal_collapse and collapse_cost of quadric.h, in
/// single precision.
struct EdgeBlock {
    /// The edges of a block.
    /// Taste: larger blocks leave fewer vectors half empty and take more of the cache.
    static constexpr size_t kSize = 64;
    EdgeInput in[kSize];
    float cost[kSize];
    /// The new position, relative to a; not set if an end is held.
    float x[kSize], y[kSize], z[kSize];
};

/// Computes the first `count` edges; the edges behind them, up to a multiple of eight, must be
/// valid, too.
void edge_costs(EdgeBlock& block, size_t count = EdgeBlock::kSize);

/// The same bits, by the processor's vectors of four or eight numbers; eight only where it has
/// AVX2.
void edge_costs_by_4(EdgeBlock& block, size_t count);
#ifdef LODESTONE_AVX2
void edge_costs_by_8(EdgeBlock& block, size_t count);
#endif

/// The key above those of all costs. Costs are never negative, so their bits sort as they do.
/// Law: the bits of infinity in IEEE 754 single precision.
inline constexpr uint32_t kImpossible = 0x7f800000;

inline uint32_t key_of_cost(float cost) {
    const auto key = std::bit_cast<uint32_t>(cost + 0.0f);  // -0 becomes 0
    return key < kImpossible ? key : kImpossible;
}

}  // namespace lodestone::simplify
