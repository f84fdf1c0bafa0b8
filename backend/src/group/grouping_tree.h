// SPDX-License-Identifier: GPL-3.0-or-later
// GroupingTree: a grouping of items, and the cost that is expected of it (dissertation 4.5.3).
#pragma once

#include "base/maths.h"

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace lodestone::group {

/// The numbers that make things look alike besides their place: color and opacity (4), size (1),
/// shape (3), orientation (6). Each number is scaled so that 1 is a difference that keeps things
/// apart.
/// Law: the sum of these counts; 6 are the entries of a symmetric matrix.
inline constexpr size_t kFeatures = 14;
using Features = std::array<double, kFeatures>;

/// A thing to be grouped, in the frame of the whole.
struct GroupingItem {
    Box3 box;           // finite, not empty
    double weight = 1;  // weight of its features in a group's mean: > 0
    Features features{};
};

/// The number of no node.
/// Law: the largest number of 32 bits; no tree has so many nodes.
inline constexpr uint32_t kNoNode = std::numeric_limits<uint32_t>::max();

/// A grouping of items. Nodes 0...item_count-1 are the items; the others are groups of nodes,
/// reachable from the root, each with a parent of its own. The root is always a group.
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

/// The tree with all items in one group, as a flat collection has it.
GroupingTree flat_tree(size_t item_count);

/// The number of groups below the root.
size_t group_count(const GroupingTree& tree);

/// Half of a box's surface, m^2: how likely a random ray that hits something around the box hits
/// it.
double half_area(const Box3& box);

/// The boxes of all nodes; empty for nodes that are not reachable.
std::vector<Box3> boxes_of(const GroupingTree& tree, std::span<const GroupingItem> items);

/// The expected number of children that a random ray which hits the whole has to be tested with,
/// which is also the number of children that an eye in a random place has to look into: the sum
/// over groups of area(group) / area(whole) x its number of children (Goldsmith and Salmon 1987).
/// Without any area (all in one place or on one line) it is the number of children of all groups.
double expected_cost(const GroupingTree& tree, std::span<const GroupingItem> items);

}  // namespace lodestone::group
