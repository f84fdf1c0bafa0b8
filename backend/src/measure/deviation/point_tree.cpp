// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/deviation/point_tree.h"

#include <algorithm>

namespace lodestone::measure {

PointTree::PointTree(std::vector<glm::dvec3> points, std::vector<uint32_t> numbers) {
    nodes_.reserve(points.size());
    for (size_t i = 0; i < points.size(); ++i)
        nodes_.push_back({points[i], numbers[i], 0});
    build(0, nodes_.size());
}

void PointTree::build(size_t begin, size_t end) {
    if (end - begin <= kLeaf)
        return;
    Box3 box;
    for (size_t i = begin; i < end; ++i)
        box.add(nodes_[i].point);
    const glm::dvec3 size = box.size();
    int axis = size.x > size.y ? 0 : 1;
    axis = size.z > size[axis] ? 2 : axis;
    const size_t middle = begin + (end - begin) / 2;
    const auto at = [&](size_t i) { return nodes_.begin() + static_cast<std::ptrdiff_t>(i); };
    // Points in equal places are sorted by number: the tree is the same everywhere.
    std::nth_element(at(begin), at(middle), at(end),
                     [axis](const PointNode& a, const PointNode& b) {
                         return a.point[axis] != b.point[axis] ? a.point[axis] < b.point[axis]
                                                               : a.number < b.number;
                     });
    nodes_[middle].axis = static_cast<uint32_t>(axis);
    build(begin, middle);
    build(middle + 1, end);
}

}  // namespace lodestone::measure
