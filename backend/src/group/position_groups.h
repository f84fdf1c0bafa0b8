// SPDX-License-Identifier: GPL-3.0-or-later
// PositionGroups: makes groups of what stands together, so that no assembly has many children.
#pragma once

#include "model/model.h"

#include <cstddef>

namespace lodestone::group {

/// The fewest children that a caller may ask for.
/// Law: an octree cell has eight parts.
inline constexpr size_t kLeastChildren = 8;
/// The usual number of children.
/// Taste: a larger value makes flatter models, whose groups have coarser stand-ins that serve less
/// often.
inline constexpr size_t kMostChildren = 64;

/// Gives a group of more than `most` children groups of at most `most` in their place, to any
/// depth, by the octree cell that their middles are in. Every placement keeps its transform (groups
/// are placed by the identity), so occurrences stay exactly where they were; within a group they
/// keep their order. Returns the number of groups added.
///
/// Cells are those of a fixed grid of powers of two in the group's frame, and uids come from the
/// group's and the cell: an object that is added, moved or removed makes stale only the groups
/// around it. Children in one place, which no cell can part, are taken in their order. Throws
/// Error(InvalidArgument) when the object is no group, or most < kLeastChildren.
size_t group_by_position(Model& model, ObjectIndex group, size_t most = kMostChildren);

}  // namespace lodestone::group
