// SPDX-License-Identifier: GPL-3.0-or-later
// Structure: gives a flat group small groups of what belongs together (dissertation 4.5).
#pragma once

#include "group/insertion_grouping.h"
#include "group/object_traits.h"
#include "model/model.h"

namespace lodestone::group {

struct StructureReport {
    size_t structured = 0;   // groups that were flat
    size_t made = 0;         // groups that were made
    double cost_before = 0;  // expected_cost of what was structured, summed over the groups
    double cost_after = 0;
};

/// Gives those of the groups that have more than options.fewest children small groups in their
/// place, to any depth, by place, size, color, orientation and shape of the children. Every
/// placement keeps its transform (groups are placed where they are: by the identity), so
/// occurrences stay exactly where they were; what is in a group keeps its order. What deforms or
/// hides something from some rays stays where it is, for nothing ever stands for its group;
/// environment is grouped with environment. No group is left with more than options.most children.
///
/// Uids come from the group's and the members': the same members make the same group again.
/// Throws Error(InvalidArgument) when an object is no group, or most < kLeastChildren;
/// Error(Cancelled), then the model is as it was.
StructureReport structure_groups(Model& model, std::span<const ObjectIndex> groups,
                                 const StructureOptions& options, const Job& job);

/// The groups below the model's root with more than `fewest` children, lowest first.
std::vector<ObjectIndex> flat_groups(const Model& model, size_t fewest);

/// Takes groups that structure_groups() made out of a group again. Returns how many.
size_t dissolve_made_groups(Model& model, ObjectIndex group);

/// The children of a group that are grouped with each other, and where they are in its assembly:
/// ordinary things, and environment.
struct SortedChildren {
    std::vector<std::vector<uint32_t>> classes;    // places in the assembly, rising
    std::vector<std::vector<GroupingItem>> items;  // of each
};
SortedChildren sorted_children(const Model& model, ObjectIndex group,
                               const std::vector<ObjectTraits>& traits);

/// Puts a group's placements into groups as trees of their classes say; what is in no class stays.
/// Returns the number of groups made.
size_t apply_grouping(Model& model, ObjectIndex group, const SortedChildren& sorted,
                      const std::vector<GroupingTree>& trees);

}  // namespace lodestone::group
