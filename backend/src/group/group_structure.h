// SPDX-License-Identifier: GPL-3.0-or-later
// GroupStructure: gives a flat group small groups of objects that belong together (dissertation
// 4.5).
#pragma once

#include "group/insertion_grouping.h"
#include "group/object_traits.h"
#include "model/model.h"

namespace lodestone::group {

/// The result of structuring.
struct StructureReport {
    size_t structured = 0;   // groups that were flat
    size_t made = 0;         // groups that were made
    double cost_before = 0;  // expected_cost() of the structured groups, summed, in children
    double cost_after = 0;
};

/// Gives those of the groups that have more than options.fewest children small groups in their
/// place, to any depth, by place, size, color, orientation and shape of the children. Every
/// placement keeps its transform (groups are placed by the identity), so occurrences stay exactly
/// where they were; the members of a group keep their order. An object that deforms or hides
/// something from some rays stays where it is, for nothing ever stands for its group; environment
/// is grouped with environment. No group is left with more than options.most children.
///
/// Uids come from the group's and the members': the same members make the same group again. Throws
/// Error(InvalidArgument) when an object is no group, or most < kLeastChildren; Error(Cancelled),
/// then the model is as it was.
StructureReport structure_groups(Model& model, std::span<const ObjectIndex> groups,
                                 const StructureOptions& options, const Job& job);

/// The groups below the model's root with more than `fewest` children, lowest first.
std::vector<ObjectIndex> flat_groups(const Model& model, size_t fewest);

/// Takes groups that structure_groups() made out of a group again. Returns how many there were.
size_t dissolve_made_groups(Model& model, ObjectIndex group);

/// The children of a group that are grouped with each other (ordinary things in one class,
/// environment in another), and their places in the assembly.
struct SortedChildren {
    std::vector<std::vector<uint32_t>> classes;    // places in the assembly, rising
    std::vector<std::vector<GroupingItem>> items;  // the items of each class
};
SortedChildren sorted_children(const Model& model, ObjectIndex group,
                               const std::vector<ObjectTraits>& traits);

/// Puts a group's placements into groups as the trees of their classes say; a placement in no class
/// stays. Returns the number of groups made.
size_t apply_grouping(Model& model, ObjectIndex group, const SortedChildren& sorted,
                      const std::vector<GroupingTree>& trees);

}  // namespace lodestone::group
