// SPDX-License-Identifier: GPL-3.0-or-later
// Grouping tree: a grouping of items, and what it is expected to cost (dissertation 4.5.3).
#pragma once

#include "base/maths.h"

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace lodestone::group {

/// What makes things look alike besides their place: color and opacity (4), size (1), shape (3),
/// orientation (6). Each number is scaled so that 1 is a difference that keeps things apart.
inline constexpr size_t kFeatures = 14;
using Features = std::array<double, kFeatures>;

/// Something to be grouped, in the frame of the whole.
struct GroupingItem {
    Box3 box;           // finite, not empty
    double weight = 1;  // of its features in a group's: > 0
    Features features{};
};

inline constexpr uint32_t kNoNode = std::numeric_limits<uint32_t>::max();

/// Nodes 0...item_count-1 are the items; the others are groups of nodes, reachable from the root,
/// each with a parent of its own. The root is always a group.
struct GroupingTree {
    struct GroupingNode {
        uint32_t parent = kNoNode;
        std::vector<uint32_t> children;
    };
    size_t item_count = 0;
    uint32_t root = kNoNode;
    std::vector<GroupingNode> nodes;

    bool is_item(uint32_t node) const { return node < item_count; }
};

/// All items in one group: how a flat collection is.
GroupingTree flat_tree(size_t item_count);

/// Groups below the root.
size_t group_count(const GroupingTree& tree);

/// Half of a box's surface: how likely a random ray that hits something around it hits it.
double half_area(const Box3& box);

/// The boxes of all nodes; empty for nodes that are not reachable.
std::vector<Box3> boxes_of(const GroupingTree& tree, std::span<const GroupingItem> items);

/// Expected number of children that a random ray which hits the whole has to be tested with, which
/// is that of the children an eye in a random place has to look into: the sum over groups of
/// area(group) / area(whole) x its number of children (Goldsmith and Salmon). Without any area (all
/// in one place or on one line) it is the number of children of all groups.
double expected_cost(const GroupingTree& tree, std::span<const GroupingItem> items);

}  // namespace lodestone::group
