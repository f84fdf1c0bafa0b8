// SPDX-License-Identifier: GPL-3.0-or-later
// Grouping by position: what stands together becomes a group, so that no assembly has many
// children.
#pragma once

#include "model/model.h"

#include <cstddef>

namespace lodestone::group {

/// Fewest children one may ask for: a cell has eight parts.
inline constexpr size_t kLeastChildren = 8;
inline constexpr size_t kMostChildren = 64;  // DESIGN 5: usual

/// Gives a group of more than `most` children groups of at most `most` in their place, to any
/// depth, by the octree cell their middles are in. Every placement keeps its transform (groups are
/// placed where they are: by the identity), so occurrences stay exactly where they were; within a
/// group they keep their order. Returns the number of groups added.
///
/// Cells are those of a fixed grid of powers of two in the group's frame, and uids come from the
/// group's and the cell: something added, moved or removed makes stale only the groups around it.
/// Children in one place, which no cell can part, are taken in their order.
/// Throws Error(InvalidArgument) when the object is no group, or most < kLeastChildren.
size_t group_by_position(Model& model, ObjectIndex group, size_t most = kMostChildren);

}  // namespace lodestone::group
