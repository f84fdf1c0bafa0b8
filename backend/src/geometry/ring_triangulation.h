// SPDX-License-Identifier: GPL-3.0-or-later
// Ring triangulation: islands with holes as well-shaped triangles.
#pragma once

#include "base/job.h"
#include "geometry/level_rings.h"

#include <glm/vec3.hpp>

namespace lodestone {

/// Triangles of the plane, counterclockwise.
struct PlaneTriangles {
    std::vector<glm::dvec2> points;
    std::vector<glm::uvec3> triangles;

    double area() const;
};

/// The inside of rings as triangles whose corners are theirs. Ears are cut, holes having been
/// joined to their island by a line; then edges inside are turned until no circle around a triangle
/// has a corner of its neighbor in it, so that triangles are as round as the rings let them be.
/// Rings that cross give triangles of another area. cost: up to O(n^2) of an island's corners.
/// Throws Error(Cancelled).
PlaneTriangles triangulated(const std::vector<Ring>& rings, const Job& job = {});

}  // namespace lodestone
