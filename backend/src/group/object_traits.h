// SPDX-License-Identifier: GPL-3.0-or-later
// ObjectTraits: the features that objects are grouped by, quickly taken from their finest meshes.
#pragma once

#include "base/job.h"
#include "group/grouping_tree.h"
#include "model/model.h"

#include <vector>

namespace lodestone::group {

/// The traits of one object, in its own frame. An object that is not resident counts by its bound.
struct ObjectTraits {
    Bound bound;               // may be empty, or not finite
    double area = 0;           // m^2; hidden surface counts
    glm::dmat3 spread{0.0};    // covariance of the surface's points, m^2
    glm::dvec3 center{0.0};    // center of the surface
    glm::dvec4 look{0.0};      // mean color, display-encoded, and opacity, by area
    bool environment = false;  // true: the object is or holds Environment
    bool never = false;  // true: deforms, or hides something from some rays; nothing stands for it
};

/// The traits of all objects below some groups (others stay empty), by surface traversal (A.1).
/// cost: O(triangles); parallel over meshes.
std::vector<ObjectTraits> traits_of(const Model& model, std::span<const ObjectIndex> groups,
                                    const Job& job);

/// The item of a placement, in the frame of its assembly.
GroupingItem item_of(const ObjectTraits& traits, const Placement& placement);

}  // namespace lodestone::group
