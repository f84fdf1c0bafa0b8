// SPDX-License-Identifier: GPL-3.0-or-later
// ClosestSearch: a search for the triangle nearest to a point, whoever proposes the candidates.
#pragma once

#include "geometry/closest_on_triangle.h"
#include "ray/mesh_scene.h"

#include <functional>
#include <span>

namespace lodestone::ray {

/// The state of one search, in the frame of a scene. It is in double precision, so that the answer
/// does not depend on the candidates that were visited besides the nearest one.
struct ClosestSearch {
    std::span<const glm::vec3> positions;
    std::span<const Triangle> triangles;
    glm::dvec3 point;
    /// Whether there is anything at a point of a triangle; null: there is something everywhere.
    const std::function<bool(uint32_t triangle, double u, double v)>* shows = nullptr;
    /// Only triangles whose fronts face this way count; zero: all do.
    glm::dvec3 facing{0.0};
    double square = std::numeric_limits<double>::infinity();  // of the distance so far
    uint32_t triangle = kNoTriangle;
    geometry::OnTriangle where{};

    /// Whether some triangles, or some of their points, do not count.
    bool choosy() const { return shows != nullptr || facing != glm::dvec3(0.0); }

    /// Takes the triangle if it is nearer than all before, or as near and lower; returns whether it
    /// was.
    bool visit(uint32_t index);

    /// The radius that a search in single precision has to cover so that no triangle within
    /// `distance` is missed.
    float reach(double distance) const;

private:
    /// The nearest point of a triangle where something is shown, found to an eighth of the
    /// triangle's size and better at the edge of the hole that `hidden` lies in. False when there
    /// is nothing nearer than before.
    bool find_shown(uint32_t index, geometry::OnTriangle& hidden) const;
};

}  // namespace lodestone::ray
