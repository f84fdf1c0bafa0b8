// SPDX-License-Identifier: GPL-3.0-or-later
// Morton order: points along Morton's space-filling curve, so that neighbors are stored together.
#pragma once

#include "base/maths.h"

#include <cstdint>
#include <vector>

namespace lodestone::geometry {

/// The finite ones of `points` in the order of a curve through the cells of their box; those of a
/// cell by place, then by number. Of several points in one place only the first by number is
/// listed. `first` gets for every point the number of the first one in its place (its own number
/// when it is not finite).
std::vector<uint32_t> morton_order(const std::vector<glm::vec3>& points,
                                   std::vector<uint32_t>& first);

}  // namespace lodestone::geometry
