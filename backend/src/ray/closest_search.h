// SPDX-License-Identifier: GPL-3.0-or-later
// ClosestSearch: a search for the triangle nearest to a point, whoever proposes the candidates.
#pragma once

#include "geometry/closest_on_triangle.h"
#include "ray/mesh_scene.h"

#include <functional>
#include <span>

namespace lodestone::ray {

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
    geometry::OnTriangle where{};

    /// Whether the triangle is nearer than all before, or as near and lower.
    bool visit(uint32_t index);

    /// The radius that a search in single precision has to cover so that no triangle within
    /// `distance` is missed.
    float reach(double distance) const;

private:
    /// The nearest point of a triangle where something is, found to an eighth of its size and
    /// better at the edge of the hole that `hidden` lies in. False when there is nothing nearer
    /// than before.
    bool find_shown(uint32_t index, geometry::OnTriangle& hidden) const;
};

}  // namespace lodestone::ray
