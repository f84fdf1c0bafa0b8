// SPDX-License-Identifier: GPL-3.0-or-later
// Placement grades: few factors for the many placements of one thing, each of which is a copy of it.
#pragma once

#include <glm/vec3.hpp>

#include <vector>

namespace lodestone::povray {

/// The grades of what is around the placements of one thing.
/// Taste: a larger value shades copies more truly, for a copy of the mesh each.
inline constexpr int kPlacementGrades = 4;

/// The share of the sky that what is around a placement leaves it, and how that changes over it: its
/// crown is lighter than its stem.
struct PlacementShade {
    double share = 1;       // the mean over its surface
    double middle = 1;      // in its middle, perhaps not of 0...1 where the slope is steep
    glm::dvec3 slope{0.0};  // by metre of its own frame
};

/// At most kPlacementGrades shades in place of all: the means of those whose shares are about as
/// large.
std::vector<PlacementShade> graded(const std::vector<PlacementShade>& shades);

}  // namespace lodestone::povray
