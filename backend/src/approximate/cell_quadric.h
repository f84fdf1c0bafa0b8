// SPDX-License-Identifier: GPL-3.0-or-later
// Cell quadric: squared distances to all planes and lines of a cell's vertices, in single precision.
#pragma once

#include "base/maths.h"

#include <algorithm>

namespace lodestone::approximate {

/// Sum of w n n^T of the planes through one vertex.
struct PlaneSum {
    float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
};

/// Q(x) = y^T A y - 2 y^T b + c with y = x - origin. The origin lies within the cell, so nothing
/// cancels far from the coordinate origin, and every number stays as small as the cell.
struct CellQuadric {
    PlaneSum a;
    glm::vec3 b{0.0f};
    float c = 0;
    glm::vec3 origin{0.0f};

    static glm::vec3 times(const PlaneSum& m, const glm::vec3& v) {
        return {m.xx * v.x + m.xy * v.y + m.xz * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z,
                m.xz * v.x + m.yz * v.y + m.zz * v.z};
    }
    float trace() const { return a.xx + a.yy + a.zz; }

    /// Adds the planes of a vertex at `point`.
    void add(const PlaneSum& planes, const glm::vec3& point) {
        const glm::vec3 away = point - origin;
        const glm::vec3 pull = times(planes, away);
        add(planes);
        b += pull;
        c += glm::dot(pull, away);
    }
    /// Adds another cell's.
    void add(const CellQuadric& other) {
        const glm::vec3 away = other.origin - origin;
        const glm::vec3 pull = times(other.a, away);
        add(other.a);
        b += other.b + pull;
        c += other.c + 2 * glm::dot(away, other.b) + glm::dot(pull, away);
    }
    /// The same for the first of a sum too, whose origin it takes.
    void gather(const CellQuadric& other) {
        if (trace() > 0)
            add(other);
        else
            *this = other;
    }
    /// Where the sum is least. A must be positive definite.
    glm::vec3 lowest() const { return origin + solved(); }
    /// The least sum.
    float least() const { return std::max(0.0f, c - glm::dot(b, solved())); }

private:
    void add(const PlaneSum& other) {
        a.xx += other.xx;
        a.xy += other.xy;
        a.xz += other.xz;
        a.yy += other.yy;
        a.yz += other.yz;
        a.zz += other.zz;
    }
    /// A y = b, by Cholesky's decomposition without roots.
    glm::vec3 solved() const {
        const float d0 = 1 / a.xx;
        const float l10 = a.xy * d0;
        const float l20 = a.xz * d0;
        const float d1 = 1 / (a.yy - l10 * a.xy);
        const float t = a.yz - l10 * a.xz;
        const float l21 = t * d1;
        const float d2 = 1 / (a.zz - l20 * a.xz - l21 * t);
        const float y1 = b.y - l10 * b.x;
        const float z = (b.z - l20 * b.x - l21 * y1) * d2;
        const float y = y1 * d1 - l21 * z;
        return {b.x * d0 - l10 * y - l20 * z, y, z};
    }
};

}  // namespace lodestone::approximate
