// SPDX-License-Identifier: GPL-3.0-or-later
#include "choose/ray_class/bound_tree.h"

#include <algorithm>
#include <cmath>

namespace lodestone::choose {
namespace {

// The most bounds of a leaf.
// Taste: larger leaves make a smaller tree and more tests of bounds.
constexpr uint32_t kFew = 4;

double apart(const Box3& a, const Box3& b) {
    const glm::dvec3 gap = glm::max(glm::dvec3(0.0), glm::max(a.low - b.high, b.low - a.high));
    return glm::length(gap);
}

}  // namespace

double distance(const Bound& a, const Bound& b) {
    return std::max(apart(a.box, b.box), glm::length(a.center - b.center) - a.radius - b.radius);
}

BoundTree::BoundTree(std::vector<Bound> bounds) : bounds_(std::move(bounds)) {
    for (uint32_t i = 0; i < bounds_.size(); ++i) {
        const Bound& bound = bounds_[i];
        const glm::dvec3 sum = bound.box.low + bound.box.high;
        if (!bound.empty() && std::isfinite(sum.x + sum.y + sum.z))
            order_.push_back(i);
    }
    if (order_.empty())
        return;
    parts_.emplace_back();
    build(0, 0, static_cast<uint32_t>(order_.size()));
}

void BoundTree::build(uint32_t part, uint32_t first, uint32_t count) {
    Box3 middles;
    for (uint32_t i = first; i < first + count; ++i) {
        parts_[part].box.add(bounds_[order_[i]].box);
        middles.add(bounds_[order_[i]].box.center());
    }
    if (count <= kFew) {
        parts_[part].first = first;
        parts_[part].count = count;
        return;
    }
    const int axis = middles.longest_axis();
    const uint32_t half = count / 2;
    const auto begin = order_.begin() + first;
    std::nth_element(begin, begin + half, begin + count, [&](uint32_t a, uint32_t b) {
        const double at = bounds_[a].box.center()[axis];
        const double other = bounds_[b].box.center()[axis];
        return at != other ? at < other : a < b;
    });
    const auto children = static_cast<uint32_t>(parts_.size());
    parts_[part].first = children;
    parts_.resize(parts_.size() + 2);
    build(children, first, half);
    build(children + 1, first + half, count - half);
}

double BoundTree::nearest(const Bound& from, uint32_t but, double most,
                          const std::function<bool(const Bound&)>& counts) const {
    std::vector<uint32_t> stack;
    if (!parts_.empty())
        stack.push_back(0);
    double least = most;
    while (!stack.empty()) {
        const BoundTreeNode& part = parts_[stack.back()];
        stack.pop_back();
        if (apart(part.box, from.box) >= least)
            continue;
        if (part.count == 0) {
            stack.push_back(part.first);
            stack.push_back(part.first + 1);
            continue;
        }
        for (uint32_t i = part.first; i < part.first + part.count; ++i) {
            const Bound& bound = bounds_[order_[i]];
            const double away = std::max(0.0, distance(bound, from));
            if (order_[i] != but && away < least && counts(bound))
                least = away;
        }
    }
    return least;
}

}  // namespace lodestone::choose
