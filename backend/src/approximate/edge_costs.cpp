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

inline Lanes least(const Lanes& a, const Lanes& b) {
    return b < a ? b : a;
}

}  // namespace

void edge_costs(EdgeBlock& block) {
    for (size_t i = 0; i < EdgeBlock::kSize; i += kLanes) {
        const auto in = [&](size_t k) {
            Lanes lanes;
            std::memcpy(&lanes, &block.in[k][i], sizeof(lanes));
            return lanes;
        };
        const Vector d{in(0), in(1), in(2)};
        const Form a{in(3), in(4), in(5), in(6), in(7), in(8)};
        const Form b{in(9), in(10), in(11), in(12), in(13), in(14)};
        const Lanes trace = (a.xx + b.xx) + (a.yy + b.yy) + (a.zz + b.zz);
        const Lanes pull = kPull * trace;
        const Factors factors(Form{a.xx + b.xx + pull, a.xy + b.xy, a.xz + b.xz, a.yy + b.yy + pull,
                                   a.yz + b.yz, a.zz + b.zz + pull});
        const Vector linear = b * d - a * d;
        Vector y = factors.solve(linear);
        y = factors.solve(linear + pull * y);
        const Vector facet{in(18), in(19), in(20)};
        const Vector turned = factors.solve(facet);
        const Lanes height = dot(Vector{in(15), in(16), in(17)}, d);
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
        const Lanes end = in(21);
        Lanes cost = end < kZero ? at_a : free;
        cost = end > kZero ? at_b : cost;
        cost = cost + 4 * kLength * square * trace;
        cost = trace > 1e-37f ? cost : kZero;
        std::memcpy(&block.cost[i], &cost, sizeof(cost));
    }
}

}  // namespace lodestone::approximate
