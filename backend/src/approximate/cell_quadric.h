// SPDX-License-Identifier: GPL-3.0-or-later
// Cell quadric: squared distances to all planes and lines of a cell's vertices, in single
// precision.
#pragma once

#include "base/maths.h"

#include <algorithm>

namespace lodestone::approximate {

/// Four numbers that one instruction adds; `[i]` is one of them.
using Four = float __attribute__((vector_size(16)));

inline Four four(const glm::vec3& v, float last = 0) {
    return Four{v.x, v.y, v.z, last};
}
inline glm::vec3 first_three(const Four& v) {
    return {v[0], v[1], v[2]};
}
inline Four least_of(const Four& a, const Four& b) {
    return a < b ? a : b;
}
inline Four most_of(const Four& a, const Four& b) {
    return a > b ? a : b;
}
/// Of the first three.
inline float dot_three(const Four& a, const Four& b) {
    const Four product = a * b;
    return product[0] + product[1] + product[2];
}
inline Four cross(const Four& a, const Four& b) {
    const Four turned = a * __builtin_shufflevector(b, b, 1, 2, 0, 3) -
                        __builtin_shufflevector(a, a, 1, 2, 0, 3) * b;
    return __builtin_shufflevector(turned, turned, 1, 2, 0, 3);
}

/// Q(p) = y^T A y - 2 y^T b + c with y = p - origin. The origin lies within the cell, so nothing
/// cancels far from the coordinate origin, and every number stays as small as the cell. A line of
/// the processor's cache: rows of A, each with its number of b behind, and the origin with c.
struct CellQuadric {
    Four x{0, 0, 0, 0};
    Four y{0, 0, 0, 0};
    Four z{0, 0, 0, 0};
    Four at{0, 0, 0, 0};

    float c() const { return at[3]; }
    /// The sum of all weights.
    float trace() const { return x[0] + y[1] + z[2]; }

    /// Adds the squared distances P to planes through a point; P is given as xx xy xz yy, yz, zz,
    /// the point relative to the origin.
    void add_planes(const Four& p, float yz, float zz, const Four& away) {
        const Four pull = Four{p[0], p[1], p[2], 0} * away[0] + Four{p[1], p[3], yz, 0} * away[1] +
                          Four{p[2], yz, zz, 0} * away[2];
        x += Four{p[0], p[1], p[2], pull[0]};
        y += Four{p[1], p[3], yz, pull[1]};
        z += Four{p[2], yz, zz, pull[2]};
        at += Four{0, 0, 0, dot_three(pull, away)};
    }
    /// Adds another cell's.
    void add(const CellQuadric& other) {
        const Four away = other.at - at;
        // A times away, and behind it b times away.
        const Four pull = other.x * away[0] + other.y * away[1] + other.z * away[2];
        x += other.x + Four{0, 0, 0, pull[0]};
        y += other.y + Four{0, 0, 0, pull[1]};
        z += other.z + Four{0, 0, 0, pull[2]};
        at += Four{0, 0, 0, other.c() + 2 * pull[3] + dot_three(pull, away)};
    }
    /// The same for the first of a sum too, whose origin it takes.
    void gather(const CellQuadric& other) {
        if (trace() > 0)
            add(other);
        else
            *this = other;
    }
    /// Where the sum is least. A must be positive definite.
    glm::vec3 lowest() const { return first_three(at) + solved(); }
    /// The least sum.
    float least() const {
        const glm::vec3 b(x[3], y[3], z[3]);
        return std::max(0.0f, c() - glm::dot(b, solved()));
    }

private:
    /// A y = b, by Cholesky's decomposition without roots.
    glm::vec3 solved() const {
        const float d0 = 1 / x[0];
        const float l10 = x[1] * d0;
        const float l20 = x[2] * d0;
        const float d1 = 1 / (y[1] - l10 * x[1]);
        const float t = y[2] - l10 * x[2];
        const float l21 = t * d1;
        const float d2 = 1 / (z[2] - l20 * x[2] - l21 * t);
        const float y1 = y[3] - l10 * x[3];
        const float last = (z[3] - l20 * x[3] - l21 * y1) * d2;
        const float middle = y1 * d1 - l21 * last;
        return {x[3] * d0 - l10 * middle - l20 * last, middle, last};
    }
};

}  // namespace lodestone::approximate
