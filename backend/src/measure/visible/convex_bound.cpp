// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/visible/convex_bound.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lodestone::measure {
namespace {

/// Law: the pairs of opposite faces, edges and corners of a cube (3 + 6 + 4).
constexpr size_t kSlabs = 13;

struct SlabPlane {
    glm::dvec3 normal;  // outward, unit
    double offset;      // normal . x = offset
};

/// One direction of each pair of opposite ones to the faces, edges and corners of a cube.
std::array<glm::dvec3, kSlabs> slab_directions() {
    std::array<glm::dvec3, kSlabs> out;
    size_t count = 0;
    for (int x = -1; x <= 1; ++x) {
        for (int y = -1; y <= 1; ++y) {
            for (int z = -1; z <= 1; ++z) {
                const int first = x != 0 ? x : (y != 0 ? y : z);
                if (first > 0)
                    out[count++] = glm::normalize(glm::dvec3(x, y, z));
            }
        }
    }
    return out;
}

/// Makes two unit vectors that are a right-handed frame with a unit normal.
void tangents(const glm::dvec3& normal, glm::dvec3& side, glm::dvec3& other) {
    const glm::dvec3 helper = std::abs(normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    side = glm::normalize(glm::cross(helper, normal));
    other = glm::cross(normal, side);
}

/// Keeps the part of a convex polygon behind a plane.
void clip(std::vector<glm::dvec3>& polygon, const SlabPlane& plane,
          std::vector<glm::dvec3>& spare) {
    spare.clear();
    for (size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec3& from = polygon[i];
        const glm::dvec3& to = polygon[i + 1 < polygon.size() ? i + 1 : 0];
        const double a = glm::dot(plane.normal, from) - plane.offset;
        const double b = glm::dot(plane.normal, to) - plane.offset;
        if (a <= 0)
            spare.push_back(from);
        if ((a < 0 && b > 0) || (a > 0 && b < 0))
            spare.push_back(from + (a / (a - b)) * (to - from));
    }
    polygon.swap(spare);
}

}  // namespace

ConvexBound::ConvexBound(std::span<const glm::dvec3> points, const glm::dmat3& axes, double lift) {
    if (points.empty() || !(lift > 0))
        return;
    static const std::array<glm::dvec3, kSlabs> kUnturned = slab_directions();
    std::array<glm::dvec3, kSlabs> directions;
    std::array<double, kSlabs> low;
    std::array<double, kSlabs> high;
    for (size_t i = 0; i < kSlabs; ++i) {
        directions[i] = axes * kUnturned[i];
        low[i] = std::numeric_limits<double>::infinity();
        high[i] = -low[i];
    }
    // Coordinates are about the first point, so that the planes keep their digits far from the
    // origin.
    const glm::dvec3 center = points[0];
    double radius = 0;
    for (const glm::dvec3& point : points) {
        const glm::dvec3 local = point - center;
        radius = std::max(radius, glm::dot(local, local));
        for (size_t i = 0; i < kSlabs; ++i) {
            const double along = glm::dot(directions[i], local);
            low[i] = std::min(low[i], along);
            high[i] = std::max(high[i], along);
        }
    }
    std::vector<SlabPlane> planes;
    for (size_t i = 0; i < kSlabs; ++i) {
        planes.push_back({directions[i], high[i] + lift});
        planes.push_back({-directions[i], lift - low[i]});
    }
    const double reach = 4 * (std::sqrt(radius) + lift);
    double area = 0;
    std::vector<glm::dvec3> polygon;
    std::vector<glm::dvec3> spare;
    for (size_t i = 0; i < planes.size(); ++i) {
        const SlabPlane& plane = planes[i];
        glm::dvec3 side;
        glm::dvec3 other;
        tangents(plane.normal, side, other);
        const glm::dvec3 foot = plane.offset * plane.normal;
        polygon = {foot - reach * side - reach * other, foot + reach * side - reach * other,
                   foot + reach * side + reach * other, foot - reach * side + reach * other};
        for (size_t j = 0; j < planes.size() && polygon.size() > 2; ++j) {
            if (j != i)
                clip(polygon, planes[j], spare);
        }
        for (size_t k = 2; k < polygon.size(); ++k) {
            const glm::dvec3 ab = polygon[k - 1] - polygon[0];
            const glm::dvec3 ac = polygon[k] - polygon[0];
            const double part = 0.5 * glm::length(glm::cross(ab, ac));
            if (!(part > 0) || !std::isfinite(part))
                continue;
            area += part;
            faces_.push_back({center + polygon[0], ab, ac, -plane.normal, area});
        }
    }
}

BoundRay ConvexBound::entering_ray(const std::array<double, 4>& u) const {
    const double target = u[0] * area();
    auto face = std::upper_bound(
        faces_.begin(), faces_.end(), target,
        [](double value, const BoundFace& candidate) { return value < candidate.area_up_to; });
    if (face == faces_.end())
        --face;
    // After the choice of the face, the rest of the first number is uniform again.
    const double before = face == faces_.begin() ? 0 : std::prev(face)->area_up_to;
    const double rest = std::clamp((target - before) / (face->area_up_to - before), 0.0, 1.0);
    const glm::dvec2 weights = uniform_in_triangle(rest, u[1]);
    return {face->corner + weights.x * face->side + weights.y * face->other,
            cosine_direction(face->inward, u[2], u[3])};
}

glm::dvec3 cosine_direction(const glm::dvec3& normal, double u, double v) {
    glm::dvec3 side;
    glm::dvec3 other;
    tangents(normal, side, other);
    const double radius = std::sqrt(u);
    const double turn = 2 * std::numbers::pi * v;
    // The direction is never quite parallel to the surface, where a ray would stay in it.
    const double height = std::sqrt(std::max(1 - u, 1e-12));
    return radius * (std::cos(turn) * side + std::sin(turn) * other) + height * normal;
}

glm::dvec2 uniform_in_triangle(double u, double v) {
    const double root = std::sqrt(u);
    return {root * (1 - v), root * v};
}

}  // namespace lodestone::measure
