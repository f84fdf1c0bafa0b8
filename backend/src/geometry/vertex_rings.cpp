// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/vertex_rings.h"

#include "geometry/closest_on_triangle.h"

#include <cmath>

namespace lodestone::geometry {

bool NearestWalk::visit(uint32_t index) {
    uint32_t& recent = recent_[index % recent_.size()];
    if (recent == index)
        return false;
    recent = index;
    const Triangle& t = triangles_[index];
    const glm::dvec3 a(points_[t.x]);
    const glm::dvec3 b(points_[t.y]);
    const glm::dvec3 c(points_[t.z]);
    const OnTriangle on = closest_on_triangle(from_, a, b, c);
    const glm::dvec3 arm = on.point - from_;
    const double square = glm::dot(arm, arm);
    // The nearest point may lie on the edge between two triangles.
    const glm::dvec3 sum = a + b + c;
    if (!std::isfinite(square) || !std::isfinite(sum.x + sum.y + sum.z))
        return false;
    if (square > square_ || (square == square_ && index > triangle_))
        return false;
    square_ = square;
    triangle_ = index;
    u_ = on.u;
    v_ = on.v;
    return true;
}

}  // namespace lodestone::geometry
