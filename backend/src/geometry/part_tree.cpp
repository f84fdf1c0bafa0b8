// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/part_tree.h"

#include <algorithm>
#include <numeric>

namespace lodestone::geometry {
namespace {

/// The middle of a triangle's box; of one that has none, or that is not finite, the origin: such
/// triangles lie in some part.
glm::dvec3 middle_of(const Box3& box) {
    const glm::dvec3 middle = box.center();
    return finite(middle) ? middle : glm::dvec3(0.0);
}

}  // namespace

PartTree::PartTree(const Mesh& mesh) : order_(mesh.triangles.size()) {
    if (order_.empty())
        return;
    std::iota(order_.begin(), order_.end(), 0u);
    std::vector<Box3> boxes(order_.size());
    std::vector<glm::dvec3> middles(order_.size());
    for (size_t i = 0; i < order_.size(); ++i) {
        for (int corner = 0; corner < 3; ++corner)
            boxes[i].add(glm::dvec3(mesh.positions[mesh.triangles[i][corner]]));
        middles[i] = middle_of(boxes[i]);
    }
    parts_.reserve(4 * order_.size() / kFewTogether);
    add({boxes, middles}, 0, static_cast<uint32_t>(order_.size()));
}

/// Adds the part of the triangles from `begin` to `end` of the order, and its halves; returns its
/// box.
Box3 PartTree::add(const TriangleBoxes& given, uint32_t begin, uint32_t end) {
    Box3 box;
    const size_t at = parts_.size();
    parts_.push_back({{}, begin, end, 0});
    if (end - begin <= kFewTogether) {
        for (uint32_t i = begin; i < end; ++i)
            box.add(given.boxes[order_[i]]);
    } else {
        Box3 middles;
        for (uint32_t i = begin; i < end; ++i)
            middles.add(given.middles[order_[i]]);
        const int axis = middles.longest_axis();
        const uint32_t half = begin + (end - begin) / 2;
        const auto place = [&](uint32_t i) { return order_.begin() + static_cast<ptrdiff_t>(i); };
        std::nth_element(place(begin), place(half), place(end), [&](uint32_t a, uint32_t b) {
            return given.middles[a][axis] < given.middles[b][axis];
        });
        box = add(given, begin, half);
        box.add(add(given, half, end));
    }
    parts_[at].box = box;
    parts_[at].next = static_cast<uint32_t>(parts_.size());
    return box;
}

}  // namespace lodestone::geometry
