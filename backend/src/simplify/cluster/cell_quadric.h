// SPDX-License-Identifier: GPL-3.0-or-later
// Cell quadric: the squared distances to all planes and lines of a cell's vertices, in single
// precision.
#pragma once

#include "base/maths.h"

#include <algorithm>

namespace lodestone::simplify {

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
/// The dot product of the first three numbers.
inline float dot_three(const Four& a, const Four& b) {
    const Four product = a * b;
    return product[0] + product[1] + product[2];
}
inline Four cross(const Four& a, const Four& b) {
    const Four turned = a * __builtin_shufflevector(b, b, 1, 2, 0, 3) -
                        __builtin_shufflevector(a, a, 1, 2, 0, 3) * b;
    return __builtin_shufflevector(turned, turned, 1, 2, 0, 3);
}

/// The quadric Q(p) = y^T A y - 2 y^T b + c with y = p - origin. The origin lies within the cell,
/// so nothing cancels far from the coordinate origin, and every number stays as small as the cell.
/// It fills one line of the processor's cache.
struct CellQuadric {
    Four planes_a{0, 0, 0, 0};  // the elements xx xy xz yy of A
    Four planes_b{0, 0, 0, 0};  // yz zz 0 0
    Four pull{0, 0, 0, 0};      // b, followed by c
    Four at{0, 0, 0, 0};        // the origin, followed by 0

    float c() const { return pull[3]; }
    /// The sum of all weights.
    float trace() const { return planes_a[0] + planes_a[3] + planes_b[1]; }

    /// Adds the squared distances to a plane through a point `away` from the origin. The length of
    /// `normal` is the root of the weight; `more_a` and `more_b` are its products with itself, as
    /// above.
    void add_plane(const Four& normal, const Four& more_a, const Four& more_b, const Four& away) {
        const float distance = dot_three(normal, away);
        planes_a += more_a;
        planes_b += more_b;
        pull += (normal + Four{0, 0, 0, 1} * distance) * distance;
    }
    /// Adds the squared distances to planes through a point `away` from the origin.
    void add_planes(const Four& more_a, const Four& more_b, const Four& away) {
        const Four moved = product(more_a, more_b, away);
        planes_a += more_a;
        planes_b += more_b;
        pull += moved + Four{0, 0, 0, 1} * dot_three(moved, away);
    }
    /// Adds the quadric of another cell.
    void add(const CellQuadric& other) {
        const Four away = other.at - at;
        const Four moved = product(other.planes_a, other.planes_b, away);
        planes_a += other.planes_a;
        planes_b += other.planes_b;
        pull += other.pull + moved +
                Four{0, 0, 0, 1} * dot_three(other.pull + other.pull + moved, away);
    }
    /// Adds another quadric; the first one of a sum also sets the origin.
    void gather(const CellQuadric& other) {
        if (trace() > 0)
            add(other);
        else
            *this = other;
    }
    /// The point where the sum is least. A must be positive definite.
    glm::vec3 lowest() const { return first_three(at) + solved(); }
    /// The value of the least sum.
    float least() const { return std::max(0.0f, c() - glm::dot(first_three(pull), solved())); }

private:
    /// The product of A and a vector whose last number is 0; so is that of the result.
    static Four product(const Four& a, const Four& b, const Four& v) {
        const Four sum = a * v[0] + __builtin_shufflevector(a, b, 1, 3, 4, 7) * v[1] +
                         __builtin_shufflevector(a, b, 2, 4, 5, 7) * v[2];
        return sum * Four{1, 1, 1, 0};
    }
    /// Solves A y = b, by Cholesky's decomposition without roots.
    glm::vec3 solved() const {
        const float d0 = 1 / planes_a[0];
        const float l10 = planes_a[1] * d0;
        const float l20 = planes_a[2] * d0;
        const float d1 = 1 / (planes_a[3] - l10 * planes_a[1]);
        const float t = planes_b[0] - l10 * planes_a[2];
        const float l21 = t * d1;
        const float d2 = 1 / (planes_b[1] - l20 * planes_a[2] - l21 * t);
        const float y1 = pull[1] - l10 * pull[0];
        const float last = (pull[2] - l20 * pull[0] - l21 * y1) * d2;
        const float middle = y1 * d1 - l21 * last;
        return {pull[0] * d0 - l10 * middle - l20 * last, middle, last};
    }
};

}  // namespace lodestone::simplify
