// SPDX-License-Identifier: GPL-3.0-or-later
// Object traits: what objects are grouped by, quickly taken from their finest representations.
#pragma once

#include "base/job.h"
#include "group/grouping_tree.h"
#include "model/model.h"

#include <vector>

namespace lodestone::group {

/// Of one object, in its own frame. What is not resident counts by its bound.
struct ObjectTraits {
    Bound bound;               // may be empty, or not finite
    double area = 0;           // of the surface, m^2; hidden surface counts
    glm::dmat3 spread{0.0};    // covariance of the surface's points, m^2
    glm::dvec3 center{0.0};    // of the surface
    glm::dvec4 look{0.0};      // mean color, display-encoded, and opacity, by area
    bool environment = false;  // is or holds Environment
    bool never = false;        // deforms, or hides something from some rays: nothing stands for it
};

/// Of all objects below some groups (others stay empty), by surface traversal (A.1).
/// cost: O(triangles); parallel over meshes.
std::vector<ObjectTraits> traits_of(const Model& model, std::span<const ObjectIndex> groups,
                                    const Job& job);

/// A placement of something, as it is grouped.
GroupingItem item_of(const ObjectTraits& traits, const Placement& placement);

}  // namespace lodestone::group
