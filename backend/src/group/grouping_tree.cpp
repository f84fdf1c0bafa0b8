// SPDX-License-Identifier: GPL-3.0-or-later
#include "group/grouping_tree.h"

#include <numeric>

namespace lodestone::group {
namespace {

/// The reachable nodes, parents before children.
std::vector<uint32_t> top_down(const GroupingTree& tree) {
    std::vector<uint32_t> order;
    if (tree.root == kNoNode)
        return order;
    order.push_back(tree.root);
    for (size_t at = 0; at < order.size(); ++at) {
        const std::vector<uint32_t>& children = tree.nodes[order[at]].children;
        order.insert(order.end(), children.begin(), children.end());
    }
    return order;
}

}  // namespace

GroupingTree flat_tree(size_t item_count) {
    GroupingTree tree;
    tree.item_count = item_count;
    tree.nodes.resize(item_count + 1);
    tree.root = static_cast<uint32_t>(item_count);
    std::vector<uint32_t>& children = tree.nodes[tree.root].children;
    children.resize(item_count);
    std::iota(children.begin(), children.end(), 0u);
    for (size_t i = 0; i < item_count; ++i)
        tree.nodes[i].parent = tree.root;
    return tree;
}

size_t group_count(const GroupingTree& tree) {
    size_t groups = 0;
    for (const uint32_t node : top_down(tree))
        groups += tree.is_item(node) || node == tree.root ? 0 : 1;
    return groups;
}

double half_area(const Box3& box) {
    const glm::dvec3 size = box.size();
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

std::vector<Box3> boxes_of(const GroupingTree& tree, std::span<const GroupingItem> items) {
    std::vector<Box3> boxes(tree.nodes.size());
    const std::vector<uint32_t> order = top_down(tree);
    for (auto at = order.rbegin(); at != order.rend(); ++at) {
        if (tree.is_item(*at))
            boxes[*at] = items[*at].box;
        for (const uint32_t child : tree.nodes[*at].children)
            boxes[*at].add(boxes[child]);
    }
    return boxes;
}

double expected_cost(const GroupingTree& tree, std::span<const GroupingItem> items) {
    if (tree.root == kNoNode)
        return 0;
    const std::vector<Box3> boxes = boxes_of(tree, items);
    const double whole = half_area(boxes[tree.root]);
    double cost = 0;
    for (const uint32_t node : top_down(tree)) {
        const auto children = static_cast<double>(tree.nodes[node].children.size());
        cost += children * (whole > 0 ? half_area(boxes[node]) / whole : 1.0);
    }
    return cost;
}

}  // namespace lodestone::group
