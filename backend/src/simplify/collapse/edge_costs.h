// SPDX-License-Identifier: GPL-3.0-or-later
// Edge costs: what collapsing costs for many edges at once, in the processor's vectors.
#pragma once

#include "base/maths.h"

#include <bit>
#include <cstddef>
#include <cstdint>

namespace lodestone::simplify {

/// Of a vertex: where it is, the sum of the area vectors around it, its quadric.
struct VertexAround {
    glm::vec3 point{0.0f};
    glm::vec3 facet{0.0f};
    float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
};

/// An edge's two ends, the sum of the area vectors of the triangles on it, and which end is held
/// (-1: a, 1: b, 0: none).
struct EdgeInput {
    const VertexAround* a;
    const VertexAround* b;
    glm::vec3 shared{0.0f};
    float held = 0;
};

/// As optimal_collapse and collapse_cost of quadric.h, in single precision.
struct EdgeBlock {
    static constexpr size_t kSize = 64;
    EdgeInput in[kSize];
    float cost[kSize];
    float x[kSize], y[kSize], z[kSize];  // where it goes, from a; unless an end is held
};

/// Of the first `count` edges; those after them up to the next eight must be there, too.
void edge_costs(EdgeBlock& block, size_t count = EdgeBlock::kSize);

/// The same bits, by the processor's vectors; of eight only where it has AVX2.
void edge_costs_by_4(EdgeBlock& block, size_t count);
#ifdef LODESTONE_AVX2
void edge_costs_by_8(EdgeBlock& block, size_t count);
#endif

/// Costs are never negative: their bits sort as they do. Above all of them:
inline constexpr uint32_t kImpossible = 0x7f800000;

inline uint32_t key_of_cost(float cost) {
    const auto key = std::bit_cast<uint32_t>(cost + 0.0f);  // of -0 that of 0
    return key < kImpossible ? key : kImpossible;
}

}  // namespace lodestone::simplify
