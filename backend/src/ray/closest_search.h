// SPDX-License-Identifier: GPL-3.0-or-later
// ClosestSearch: a search for the triangle nearest to a point, whoever proposes the candidates.
#pragma once

#include "ray/mesh_scene.h"

#include <functional>
#include <span>

namespace lodestone::ray {

/// The point of a triangle that is closest to another: (1-u-v) a + u b + v c.
struct OnTriangle {
    glm::dvec3 point{0.0};
    double u = 0;
    double v = 0;
};
/// Also of a triangle without area.
OnTriangle closest_on_triangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b,
                               const glm::dvec3& c);

/// The search's state in a scene's own frame. In double precision, so that the answer does not
/// depend on the candidates that were visited besides the nearest one.
struct ClosestSearch {
    std::span<const glm::vec3> positions;
    std::span<const Triangle> triangles;
    glm::dvec3 point;
    /// Whether there is anything at a point of a triangle; null: everywhere.
    const std::function<bool(uint32_t triangle, double u, double v)>* shows = nullptr;
    double square = std::numeric_limits<double>::infinity();  // of the distance
    uint32_t triangle = kNoTriangle;
    OnTriangle where{};

    /// Whether the triangle is nearer than all before, or as near and lower.
    bool visit(uint32_t index);

    /// The radius that a search in single precision has to cover so that no triangle within
    /// `distance` is missed.
    float reach(double distance) const;

private:
    /// The nearest point of a triangle where something is, found to an eighth of its size and
    /// better at the edge of the hole that `hidden` lies in. False when there is nothing nearer
    /// than before.
    bool find_shown(uint32_t index, OnTriangle& hidden) const;
};

}  // namespace lodestone::ray
