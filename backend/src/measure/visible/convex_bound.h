// SPDX-License-Identifier: GPL-3.0-or-later
// ConvexBound: the tight polytope around a mesh that its line samples enter through.
#pragma once

#include "base/maths.h"

#include <array>
#include <span>
#include <vector>

namespace lodestone::measure {

/// A ray and the face it leaves from: origin on the face, direction of unit length.
struct BoundRay {
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0.0};
};

/// The intersection of 26 half-spaces (faces, edges and corners of a cube as directions), in a
/// frame turned like the mesh. Rays from its surface that are uniform in area and follow the
/// cosine in direction are uniform over all lines that cross it, so the share of them that hits
/// something times area() is the visible surface area of that (4.17, 4.18).
class ConvexBound {
public:
    /// Encloses the points, `lift` metres further out (> 0, so that the bound has a volume).
    ConvexBound(std::span<const glm::dvec3> points, const glm::dmat3& axes, double lift);

    /// The area of the bound's surface, m^2.
    double area() const { return faces_.empty() ? 0 : faces_.back().area_up_to; }

    /// The inward ray of four numbers in [0, 1). Needs area() > 0.
    BoundRay entering_ray(const std::array<double, 4>& u) const;

private:
    struct BoundFace {
        glm::dvec3 corner, side, other;  // a triangle of the polytope's surface
        glm::dvec3 inward;
        double area_up_to;  // the area of this face and of all before
    };
    std::vector<BoundFace> faces_;
};

/// A direction over the hemisphere of a unit normal with density cosine / pi, from two numbers.
glm::dvec3 cosine_direction(const glm::dvec3& normal, double u, double v);

/// Two numbers in [0, 1) to weights of a triangle's second and third corner, uniform in area.
glm::dvec2 uniform_in_triangle(double u, double v);

}  // namespace lodestone::measure
