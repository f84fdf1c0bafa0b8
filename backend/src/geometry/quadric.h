// SPDX-License-Identifier: GPL-3.0-or-later
// Quadric: the squared distances to a vertex's planes, and the best place of a collapsed edge.
#pragma once

#include "base/maths.h"

namespace lodestone::geometry {

/// The symmetric matrix of sum w n n^T. All planes of a vertex pass through it, so relative to its
/// position this is the whole quadric: six numbers, and no cancellation far from the origin.
struct Quadric {
    double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

    /// Adds `weight` times n n^T; n may have any length.
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

/// The pull towards the middle of the edge, relative to the trace. It decides only the directions
/// that the planes leave open (along a flat surface or a straight ridge).
/// Taste: a larger pull moves vertices off ridges; a smaller one drowns in rounding.
inline constexpr double kEdgePull = 1e-4;
/// The cost of an edge's length, which decides between collapses that cost nothing: the shortest
/// edge goes first and keeps flat regions well shaped.
/// Taste: a larger one competes with real costs; a smaller one is lost in rounding.
inline constexpr double kEdgeLength = 1e-8;

/// One end of an edge as the cost sees it.
struct EdgeEnd {
    glm::dvec3 point;
    Quadric quadric;   // that of its planes
    glm::dvec3 facet;  // the sum of the area vectors around it
};

struct CollapseOptimum {
    glm::dvec3 point{0.0};
    double cost = 0;  // the integral of squared distance over the surface around, m^4
};

/// The place of the collapsed edge with the least squared distance to both ends' planes that keeps
/// the enclosed volume. `shared`: the area vectors of the triangles at both ends (counted once).
CollapseOptimum optimal_collapse(const EdgeEnd& a, const EdgeEnd& b, const glm::dvec3& shared);

/// The cost of collapsing to `point`.
double collapse_cost(const EdgeEnd& a, const EdgeEnd& b, const glm::dvec3& point);

}  // namespace lodestone::geometry
