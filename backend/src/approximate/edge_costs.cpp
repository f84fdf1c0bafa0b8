// SPDX-License-Identifier: GPL-3.0-or-later
#include "approximate/edge_costs.h"

#include "approximate/quadric.h"

#include <cstring>

namespace lodestone::approximate {
namespace {

using Lanes = float __attribute__((vector_size(16)));
constexpr size_t kLanes = 4;
constexpr auto kPull = static_cast<float>(kEdgePull);
constexpr auto kLength = static_cast<float>(kEdgeLength);
constexpr Lanes kZero{};

struct Vector {
    Lanes x, y, z;
};
inline Vector operator+(const Vector& a, const Vector& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vector operator-(const Vector& a, const Vector& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vector operator*(const Lanes& s, const Vector& a) {
    return {s * a.x, s * a.y, s * a.z};
}
inline Lanes dot(const Vector& a, const Vector& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// A symmetric matrix.
struct Form {
    Lanes xx, xy, xz, yy, yz, zz;
    Vector operator*(const Vector& v) const {
        return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z,
                xz * v.x + yz * v.y + zz * v.z};
    }
    /// v^T M v, which rounding does not make negative.
    Lanes of(const Vector& v) const {
        const Lanes value = dot(v, *this * v);
        return value > kZero ? value : kZero;
    }
};

/// L D L^T.
struct Factors {
    Lanes l10, l20, l21, d0, d1, d2;
    explicit Factors(const Form& m) {
        d0 = 1 / m.xx;
        l10 = m.xy * d0;
        l20 = m.xz * d0;
        d1 = 1 / (m.yy - l10 * m.xy);
        const Lanes t = m.yz - l10 * m.xz;
        l21 = t * d1;
        d2 = 1 / (m.zz - l20 * m.xz - l21 * t);
    }
    Vector solve(const Vector& b) const {
        const Lanes y = b.y - l10 * b.x;
        Vector x;
        x.z = (b.z - l20 * b.x - l21 * y) * d2;
        x.y = y * d1 - l21 * x.z;
        x.x = b.x * d0 - l10 * x.y - l20 * x.z;
        return x;
    }
};

/// Rows of four edges to columns, four numbers at a time.
constexpr size_t kColumns = sizeof(EdgeInput) / sizeof(float);
static_assert(kColumns % kLanes == 0 && sizeof(EdgeInput) == kColumns * sizeof(float));

inline void transpose(const EdgeInput* rows, Lanes (&columns)[kColumns]) {
    for (size_t k = 0; k < kColumns; k += kLanes) {
        Lanes row[kLanes];
        for (size_t i = 0; i < kLanes; ++i)
            std::memcpy(&row[i], reinterpret_cast<const std::byte*>(rows + i) + k * sizeof(float),
                        sizeof(Lanes));
        const Lanes low_01 = __builtin_shufflevector(row[0], row[1], 0, 4, 1, 5);
        const Lanes low_23 = __builtin_shufflevector(row[2], row[3], 0, 4, 1, 5);
        const Lanes high_01 = __builtin_shufflevector(row[0], row[1], 2, 6, 3, 7);
        const Lanes high_23 = __builtin_shufflevector(row[2], row[3], 2, 6, 3, 7);
        columns[k] = __builtin_shufflevector(low_01, low_23, 0, 1, 4, 5);
        columns[k + 1] = __builtin_shufflevector(low_01, low_23, 2, 3, 6, 7);
        columns[k + 2] = __builtin_shufflevector(high_01, high_23, 0, 1, 4, 5);
        columns[k + 3] = __builtin_shufflevector(high_01, high_23, 2, 3, 6, 7);
    }
}

inline Lanes least(const Lanes& a, const Lanes& b) {
    return b < a ? b : a;
}

}  // namespace

void edge_costs(EdgeBlock& block) {
    for (size_t i = 0; i < EdgeBlock::kSize; i += kLanes) {
        Lanes in[kColumns];
        transpose(block.in + i, in);
        const Vector d = Lanes{0.5f, 0.5f, 0.5f, 0.5f} *
                         (Vector{in[12], in[13], in[14]} - Vector{in[0], in[1], in[2]});
        const Vector facet_a{in[3], in[4], in[5]};
        const Vector facet_b{in[15], in[16], in[17]};
        const Form a{in[6], in[7], in[8], in[9], in[10], in[11]};
        const Form b{in[18], in[19], in[20], in[21], in[22], in[23]};
        const Lanes trace = (a.xx + b.xx) + (a.yy + b.yy) + (a.zz + b.zz);
        const Lanes pull = kPull * trace;
        const Factors factors(Form{a.xx + b.xx + pull, a.xy + b.xy, a.xz + b.xz, a.yy + b.yy + pull,
                                   a.yz + b.yz, a.zz + b.zz + pull});
        const Vector linear = b * d - a * d;
        Vector y = factors.solve(linear);
        y = factors.solve(linear + pull * y);
        const Vector facet = facet_b + facet_a - Vector{in[24], in[25], in[26]};
        const Vector turned = factors.solve(facet);
        const Lanes height = dot(facet_b - facet_a, d);
        const Lanes way = (height - dot(facet, y)) / dot(facet, turned);
        const Lanes square = dot(d, d);
        const Lanes held_way = dot(facet, facet) > 0.01f * trace * trace ? way : kZero;
        const Vector move = held_way * turned;
        const Lanes step = dot(move, move) <= square ? held_way : kZero;
        y = y + step * turned;
        const Lanes best = a.of(y + d) + b.of(y - d);
        const Vector edge = d + d;
        const Lanes at_a = b.of(edge);
        const Lanes at_b = a.of(edge);
        const Lanes at_ends = least(at_a, at_b);
        const Lanes at_three = least(a.of(d) + b.of(d), at_ends);
        const Lanes free = dot(y, y) <= 9 * square ? best : at_three;
        const Lanes end = in[27];
        Lanes cost = end < kZero ? at_a : free;
        cost = end > kZero ? at_b : cost;
        cost = cost + 4 * kLength * square * trace;
        cost = trace > 1e-37f ? cost : kZero;
        std::memcpy(&block.cost[i], &cost, sizeof(cost));
    }
}

}  // namespace lodestone::approximate
