// SPDX-License-Identifier: GPL-3.0-or-later
// InsertionGrouping: groups items by inserting one after the other where it costs least (4.5.4).
#pragma once

#include "base/job.h"
#include "group/grouping_tree.h"

namespace lodestone::group {

/// The choices of a designer for groups. Larger values of orders and passes find cheaper groupings
/// in more time.
struct StructureOptions {
    uint32_t orders = 4;  // random orders that are tried; the one of the lowest expected cost wins
    /// After an order everything is put elsewhere at most so many times (very many things once).
    uint32_t passes = 2;
    size_t fewest = 64;  // a group of at most so many children is left as it is
    size_t most = 64;    // most children of a group
    /// Children that a group counts as: a larger value makes fewer and larger groups.
    double group_cost = 8;
    double similarity = 0.1;  // weight of looks beside place: 0 none at all
    uint64_t seed = 1;
};

/// Groups items. A group costs (area of its bound) x (number of its children + group_cost) x (1 +
/// similarity x the variance of its items' features). An item goes where the sum over all groups
/// grows least: into a group, or with one of its children into a new one. The way there is searched
/// best first, as long as anything could be cheaper; then every item and group is taken out and
/// inserted again.
///
/// Items in equal places are told apart by their order alone; else the result does not depend on
/// it, nor on the number of threads, nor (but for rounding) on scale and distance from the origin.
/// Throws Error(Cancelled). cost: about n log n an order.
GroupingTree group_by_insertion(std::span<const GroupingItem> items,
                                const StructureOptions& options, const Job& job);

}  // namespace lodestone::group
