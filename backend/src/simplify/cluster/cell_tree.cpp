// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/cluster/cell_tree.h"

#include <algorithm>

namespace lodestone::simplify {
namespace {

/// The left half of a node whose right half is still to come.
struct LeftHalf {
    uint32_t node;
    uint8_t split;  // between it and the next cell
    float least;    // the least value of its quadric
    float cost;     // the largest cost below it
    CellQuadric quadric;
};

}  // namespace

CellTree::CellTree(const GridCells& cells) : cells_(cells.count()) {
    if (cells_ == 0)
        return;
    parent_.assign(2 * cells_ - 1, kNoCell);
    cost_.reserve(cells_ - 1);
    ScratchVector<LeftHalf> open;
    open.reserve(64);
    for (size_t i = 0; i < cells_; ++i) {
        LeftHalf node{static_cast<uint32_t>(i), cells.split[i], 0, 0, cells.quadrics[i]};
        if (node.quadric.c() > 0)  // else all its vertices are at one point
            node.least = node.quadric.least();
        while (!open.empty() && open.back().split < node.split) {
            const LeftHalf& left = open.back();
            const auto above = static_cast<uint32_t>(cells_ + cost_.size());
            parent_[left.node] = parent_[node.node] = above;
            CellQuadric sum = left.quadric;
            sum.add(node.quadric);
            const float least = sum.least();
            const float cost =
                std::max({least - left.least - node.least, left.cost, node.cost, 0.0f});
            cost_.push_back(cost);
            node = {above, node.split, least, cost, sum};
            open.pop_back();
        }
        open.push_back(node);
    }
    order_ = cost_;
    node_.resize(parent_.size());
}

std::span<const uint32_t> CellTree::joined(size_t count) {
    const size_t joins = cells_ - std::clamp<size_t>(count, 1, std::max<size_t>(cells_, 1));
    float most = -1;
    if (joins > 0) {
        const auto at = [&](size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
        // Around the numbers of earlier calls, smaller and larger costs are separated already.
        const auto above = std::lower_bound(asked_.begin(), asked_.end(), joins - 1);
        const size_t end = above == asked_.end() ? order_.size() : *above + 1;
        const size_t begin = above == asked_.begin() ? 0 : *std::prev(above) + 1;
        std::nth_element(at(begin), at(joins - 1), at(end));
        asked_.insert(above, joins - 1);
        most = order_[joins - 1];
    }
    for (size_t i = parent_.size(); i-- > 0;) {  // parents come after their halves
        const uint32_t above = parent_[i];
        const bool inside = above != kNoCell && cost_[above - cells_] <= most;
        node_[i] = inside ? node_[above] : static_cast<uint32_t>(i);
    }
    return std::span<const uint32_t>(node_).first(cells_);
}

}  // namespace lodestone::simplify
