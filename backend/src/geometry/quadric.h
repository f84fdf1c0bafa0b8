// SPDX-License-Identifier: GPL-3.0-or-later
// Quadrics: the squared distances to a vertex's planes, and where an edge best collapses to.
#pragma once

#include "base/maths.h"

namespace lodestone::geometry {

/// Symmetric matrix of sum w n n^T. All planes of a vertex pass through it, so relative to its
/// position this is the whole quadric: six numbers, and no cancellation far from the origin.
struct Quadric {
    double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

    /// Adds `weight` times n n^T; `normal` need not be unit.
    void add(const glm::dvec3& n, double weight) {
        xx += weight * n.x * n.x;
        xy += weight * n.x * n.y;
        xz += weight * n.x * n.z;
        yy += weight * n.y * n.y;
        yz += weight * n.y * n.z;
        zz += weight * n.z * n.z;
    }
    Quadric& operator+=(const Quadric& o) {
        xx += o.xx;
        xy += o.xy;
        xz += o.xz;
        yy += o.yy;
        yz += o.yz;
        zz += o.zz;
        return *this;
    }
    glm::dvec3 operator*(const glm::dvec3& v) const {
        return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z,
                xz * v.x + yz * v.y + zz * v.z};
    }
    double trace() const { return xx + yy + zz; }
};

/// Pull towards the middle of the edge, relative to the trace: decides only the directions that the
/// planes leave open (along a flat surface or a straight ridge).
inline constexpr double kEdgePull = 1e-4;
/// Between collapses that cost nothing, the shortest edge first: keeps flat regions well shaped.
inline constexpr double kEdgeLength = 1e-8;

/// One end of an edge as the cost sees it.
struct EdgeEnd {
    glm::dvec3 point;
    Quadric quadric;   // of its planes
    glm::dvec3 facet;  // sum of the area vectors around it
};

struct CollapseOptimum {
    glm::dvec3 point{0.0};
    double cost = 0;  // integral of squared distance over the surface around, m^4
};

/// Where the edge collapses to with the least squared distance to both ends' planes, keeping the
/// enclosed volume. `shared` holds the area vectors of the triangles on both ends (counted once).
CollapseOptimum optimal_collapse(const EdgeEnd& a, const EdgeEnd& b, const glm::dvec3& shared);

/// The cost of collapsing to `point`.
double collapse_cost(const EdgeEnd& a, const EdgeEnd& b, const glm::dvec3& point);

}  // namespace lodestone::geometry
