// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/quadric.h"

#include <algorithm>
#include <cmath>

namespace lodestone::geometry {
namespace {

/// The factors L and D of a positive definite symmetric matrix, which is L D L^T.
struct LdltFactors {
    double l10, l20, l21, d0, d1, d2;

    LdltFactors(const Quadric& q, double diagonal) {
        d0 = 1 / (q.xx + diagonal);
        l10 = q.xy * d0;
        l20 = q.xz * d0;
        d1 = 1 / (q.yy + diagonal - l10 * q.xy);
        const double t = q.yz - l10 * q.xz;
        l21 = t * d1;
        d2 = 1 / (q.zz + diagonal - l20 * q.xz - l21 * t);
    }
    glm::dvec3 solve(const glm::dvec3& b) const {
        const double y0 = b.x;
        const double y1 = b.y - l10 * y0;
        const double y2 = b.z - l20 * y0 - l21 * y1;
        glm::dvec3 x;
        x.z = y2 * d2;
        x.y = y1 * d1 - l21 * x.z;
        x.x = y0 * d0 - l10 * x.y - l20 * x.z;
        return x;
    }
};

}  // namespace

double collapse_cost(const EdgeEnd& a, const EdgeEnd& b, const glm::dvec3& point) {
    const glm::dvec3 from_a = point - a.point;
    const glm::dvec3 from_b = point - b.point;
    const glm::dvec3 edge = b.point - a.point;
    const double length = glm::dot(edge, edge) * (a.quadric.trace() + b.quadric.trace());
    return std::max(0.0, glm::dot(from_a, a.quadric * from_a)) +
           std::max(0.0, glm::dot(from_b, b.quadric * from_b)) + kEdgeLength * length;
}

CollapseOptimum optimal_collapse(const EdgeEnd& a, const EdgeEnd& b, const glm::dvec3& shared) {
    // With y from the middle m and d half the edge: q(y) = y^T Q y - 2 y^T (B d - A d) + d^T Q d.
    const glm::dvec3 middle = 0.5 * (a.point + b.point);
    const glm::dvec3 d = 0.5 * (b.point - a.point);
    Quadric q = a.quadric;
    q += b.quadric;
    const double trace = q.trace();
    if (!(trace > 1e-200))
        return {middle, 0};
    const glm::dvec3 linear = b.quadric * d - a.quadric * d;
    const double pull = kEdgePull * trace;
    const LdltFactors factors(q, pull);
    // The second solve starts the pull from the first answer, so that the directions that planes
    // decide are exact to kEdgePull squared.
    glm::dvec3 y = factors.solve(linear);
    y = factors.solve(linear + pull * y);
    // The volume: facet . y = h; the shared triangles contain the edge, so they do not enter h.
    const glm::dvec3 facet = a.facet + b.facet - shared;
    if (glm::dot(facet, facet) > 0.01 * trace * trace) {
        const glm::dvec3 turned = factors.solve(facet);
        const double slope = glm::dot(facet, turned);
        const glm::dvec3 move =
            turned * ((glm::dot(b.facet - a.facet, d) - glm::dot(facet, y)) / slope);
        if (glm::dot(move, move) <= glm::dot(d, d))
            y += move;
    }
    const double reach = glm::dot(d, d);
    if (!(glm::dot(y, y) <= 9 * reach)) {
        // The corner is nearly singular and far away: take the best of three points of the edge.
        CollapseOptimum best{middle, collapse_cost(a, b, middle)};
        for (const glm::dvec3& point : {a.point, b.point}) {
            const double cost = collapse_cost(a, b, point);
            if (cost < best.cost)
                best = {point, cost};
        }
        return best;
    }
    const glm::dvec3 point = middle + y;
    return {point, collapse_cost(a, b, point)};
}

}  // namespace lodestone::geometry
