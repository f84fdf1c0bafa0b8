// SPDX-License-Identifier: GPL-3.0-or-later
// Edge cost lanes: edge costs in vectors of LODESTONE_LANES numbers; for edge_costs*.cpp alone.
// Each of these has functions of its own: code that is compiled for other processors must not be
// shared.
#pragma once

#include "geometry/quadric.h"
#include "simplify/collapse/edge_costs.h"

#include <cstddef>
#include <cstring>

namespace lodestone::simplify {
namespace {

using Lanes = float __attribute__((vector_size(4 * LODESTONE_LANES)));
inline constexpr size_t kLanes = LODESTONE_LANES;
inline constexpr auto kPull = static_cast<float>(geometry::kEdgePull);
inline constexpr auto kLength = static_cast<float>(geometry::kEdgeLength);
inline constexpr Lanes kZero{};

struct LaneVector {
    Lanes x, y, z;
};
inline LaneVector operator+(const LaneVector& a, const LaneVector& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline LaneVector operator-(const LaneVector& a, const LaneVector& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline LaneVector operator*(const Lanes& s, const LaneVector& a) {
    return {s * a.x, s * a.y, s * a.z};
}
inline Lanes dot(const LaneVector& a, const LaneVector& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// A symmetric matrix.
struct QuadraticForm {
    Lanes xx, xy, xz, yy, yz, zz;
    LaneVector operator*(const LaneVector& v) const {
        return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z,
                xz * v.x + yz * v.y + zz * v.z};
    }
    /// The value v^T M v, which rounding does not make negative.
    Lanes of(const LaneVector& v) const {
        const Lanes value = dot(v, *this * v);
        return value > kZero ? value : kZero;
    }
};

/// The factors L and D of the decomposition L D L^T.
struct LdlFactors {
    Lanes l10, l20, l21, d0, d1, d2;
    explicit LdlFactors(const QuadraticForm& m) {
        d0 = 1 / m.xx;
        l10 = m.xy * d0;
        l20 = m.xz * d0;
        d1 = 1 / (m.yy - l10 * m.xy);
        const Lanes t = m.yz - l10 * m.xz;
        l21 = t * d1;
        d2 = 1 / (m.zz - l20 * m.xz - l21 * t);
    }
    LaneVector solve(const LaneVector& b) const {
        const Lanes y = b.y - l10 * b.x;
        LaneVector x;
        x.z = (b.z - l20 * b.x - l21 * y) * d2;
        x.y = y * d1 - l21 * x.z;
        x.x = b.x * d0 - l10 * x.y - l20 * x.z;
        return x;
    }
};

/// The numbers of a vertex, and of an edge with its two vertices.
inline constexpr size_t kOfVertex = sizeof(VertexAround) / sizeof(float);
/// Law: two vertices, three numbers of `shared`, one of `held`.
inline constexpr size_t kColumns = 2 * kOfVertex + 4;
static_assert(kOfVertex % 4 == 0 && sizeof(VertexAround) == kOfVertex * sizeof(float));
static_assert(offsetof(EdgeInput, held) == offsetof(EdgeInput, shared) + 3 * sizeof(float));
static_assert(EdgeBlock::kSize % kLanes == 0);

using Four = float __attribute__((vector_size(16)));

/// The four numbers of an edge from number k on.
inline Four four_of(const EdgeInput& edge, size_t k) {
    const float* from = k < kOfVertex       ? &edge.a->point.x + k
                        : k < 2 * kOfVertex ? &edge.b->point.x + (k - kOfVertex)
                                            : &edge.shared.x;
    Four four;
    std::memcpy(&four, from, sizeof(four));
    return four;
}

/// Turns rows of edges into columns, four numbers at a time: in vectors of eight, each half holds
/// four edges.
inline void transpose(const EdgeInput* rows, Lanes (&columns)[kColumns]) {
    for (size_t k = 0; k < kColumns; k += 4) {
        Lanes row[4];
        for (size_t i = 0; i < 4; ++i) {
#if LODESTONE_LANES == 8
            row[i] = __builtin_shufflevector(four_of(rows[i], k), four_of(rows[i + 4], k), 0, 1, 2,
                                             3, 4, 5, 6, 7);
#else
            row[i] = four_of(rows[i], k);
#endif
        }
#if LODESTONE_LANES == 8
        const Lanes low_01 = __builtin_shufflevector(row[0], row[1], 0, 8, 1, 9, 4, 12, 5, 13);
        const Lanes low_23 = __builtin_shufflevector(row[2], row[3], 0, 8, 1, 9, 4, 12, 5, 13);
        const Lanes high_01 = __builtin_shufflevector(row[0], row[1], 2, 10, 3, 11, 6, 14, 7, 15);
        const Lanes high_23 = __builtin_shufflevector(row[2], row[3], 2, 10, 3, 11, 6, 14, 7, 15);
        columns[k] = __builtin_shufflevector(low_01, low_23, 0, 1, 8, 9, 4, 5, 12, 13);
        columns[k + 1] = __builtin_shufflevector(low_01, low_23, 2, 3, 10, 11, 6, 7, 14, 15);
        columns[k + 2] = __builtin_shufflevector(high_01, high_23, 0, 1, 8, 9, 4, 5, 12, 13);
        columns[k + 3] = __builtin_shufflevector(high_01, high_23, 2, 3, 10, 11, 6, 7, 14, 15);
#else
        const Lanes low_01 = __builtin_shufflevector(row[0], row[1], 0, 4, 1, 5);
        const Lanes low_23 = __builtin_shufflevector(row[2], row[3], 0, 4, 1, 5);
        const Lanes high_01 = __builtin_shufflevector(row[0], row[1], 2, 6, 3, 7);
        const Lanes high_23 = __builtin_shufflevector(row[2], row[3], 2, 6, 3, 7);
        columns[k] = __builtin_shufflevector(low_01, low_23, 0, 1, 4, 5);
        columns[k + 1] = __builtin_shufflevector(low_01, low_23, 2, 3, 6, 7);
        columns[k + 2] = __builtin_shufflevector(high_01, high_23, 0, 1, 4, 5);
        columns[k + 3] = __builtin_shufflevector(high_01, high_23, 2, 3, 6, 7);
#endif
    }
}

/// Takes a where the mask is true, else b.
template <typename Mask>
inline LaneVector choose(const Mask& mask, const LaneVector& a, const LaneVector& b) {
    return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}

inline void costs_of(EdgeBlock& block, size_t count) {
    for (size_t i = 0; i < count; i += kLanes) {
        Lanes in[kColumns];
        transpose(block.in + i, in);
        const LaneVector d =
            (kZero + 0.5f) * (LaneVector{in[12], in[13], in[14]} - LaneVector{in[0], in[1], in[2]});
        const LaneVector facet_a{in[3], in[4], in[5]};
        const LaneVector facet_b{in[15], in[16], in[17]};
        const QuadraticForm a{in[6], in[7], in[8], in[9], in[10], in[11]};
        const QuadraticForm b{in[18], in[19], in[20], in[21], in[22], in[23]};
        const Lanes trace = (a.xx + b.xx) + (a.yy + b.yy) + (a.zz + b.zz);
        const Lanes pull = kPull * trace;
        const LdlFactors factors(QuadraticForm{a.xx + b.xx + pull, a.xy + b.xy, a.xz + b.xz,
                                               a.yy + b.yy + pull, a.yz + b.yz,
                                               a.zz + b.zz + pull});
        const LaneVector linear = b * d - a * d;
        LaneVector y = factors.solve(linear);
        y = factors.solve(linear + pull * y);
        const LaneVector facet = facet_b + facet_a - LaneVector{in[24], in[25], in[26]};
        const LaneVector turned = factors.solve(facet);
        const Lanes height = dot(facet_b - facet_a, d);
        const Lanes way = (height - dot(facet, y)) / dot(facet, turned);
        const Lanes square = dot(d, d);
        const Lanes held_way = dot(facet, facet) > 0.01f * trace * trace ? way : kZero;
        const LaneVector move = held_way * turned;
        const Lanes step = dot(move, move) <= square ? held_way : kZero;
        y = y + step * turned;
        const Lanes best = a.of(y + d) + b.of(y - d);
        const LaneVector edge = d + d;
        const Lanes at_a = b.of(edge);
        const Lanes at_b = a.of(edge);
        const Lanes at_middle = a.of(d) + b.of(d);
        const Lanes at_ends = at_b < at_a ? at_b : at_a;
        const Lanes at_three = at_ends < at_middle ? at_ends : at_middle;
        const auto near = dot(y, y) <= 9 * square;
        const Lanes free = near ? best : at_three;
        const LaneVector none{kZero, kZero, kZero};
        const LaneVector at_best = choose(at_ends < at_middle, choose(at_b < at_a, edge, none), d);
        const LaneVector offset = choose(near, y + d, at_best);
        const Lanes end = in[27];
        Lanes cost = end < kZero ? at_a : free;
        cost = end > kZero ? at_b : cost;
        cost = cost + 4 * kLength * square * trace;
        cost = trace > 1e-37f ? cost : kZero;
        std::memcpy(&block.cost[i], &cost, sizeof(cost));
        const LaneVector from_a = choose(trace > 1e-37f, offset, d);
        std::memcpy(&block.x[i], &from_a.x, sizeof(Lanes));
        std::memcpy(&block.y[i], &from_a.y, sizeof(Lanes));
        std::memcpy(&block.z[i], &from_a.z, sizeof(Lanes));
    }
}

}  // namespace
}  // namespace lodestone::simplify
