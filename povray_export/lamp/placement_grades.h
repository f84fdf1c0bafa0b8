// SPDX-License-Identifier: GPL-3.0-or-later
// Placement grades: few factors for the many placements of one thing, each of which is a copy of it.
#pragma once

#include <vector>

namespace lodestone::povray {

/// The grades of what is around the placements of one thing.
/// Taste: a larger value shades copies more truly, for a copy of the mesh each.
inline constexpr int kPlacementGrades = 4;

/// At most kPlacementGrades numbers in place of all: the means of those that are about as large.
std::vector<double> graded(const std::vector<double>& shares);

}  // namespace lodestone::povray
