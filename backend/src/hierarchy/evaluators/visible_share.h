// SPDX-License-Identifier: GPL-3.0-or-later
// Visible shares: how much is seen of each kind of part.
#pragma once

#include "hierarchy/finest.h"

#include <span>
#include <vector>

namespace lodestone::hierarchy {

/// Visible area by tag (one a triangle, below `tags`) of a mesh that is the finest, all of it or
/// what of it can be seen.
std::vector<double> visible_by_tag(const Mesh& seen, std::span<const uint32_t> by_triangle,
                                   size_t tags, const MeasuredFinest& finest, const Job& job);
/// The same of a level in the finest's materials.
std::vector<double> visible_by_tag_of_level(const Mesh& level,
                                            std::span<const uint32_t> by_triangle, size_t tags,
                                            const MeasuredFinest& finest, const Job& job);

}  // namespace lodestone::hierarchy
