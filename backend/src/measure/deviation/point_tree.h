// SPDX-License-Identifier: GPL-3.0-or-later
// PointTree: a k-d tree that finds the nearest of those points that the caller wants.
// Our own although libraries (nanoflann) have k-d trees: a search asks the caller about each point
// before it counts, and points in equal places are sorted by number, so that the tree is the same
// everywhere. It is sixty lines.
#pragma once

#include "base/maths.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace lodestone::measure {

/// A balanced k-d tree (Bentley 1975) that is split at the median along the longest side of the
/// bound.
class PointTree {
public:
    PointTree() = default;
    /// `numbers` are the names of the points. All points are finite.
    PointTree(std::vector<glm::dvec3> points, std::vector<uint32_t> numbers);

    /// Whether the tree holds no point.
    bool empty() const { return nodes_.empty(); }

    /// The square of the distance (m^2) to the nearest point whose number is `wanted`, or `square`
    /// where that is not larger.
    template <typename Wanted>
    double nearest(const glm::dvec3& from, double square, const Wanted& wanted) const {
        search(0, nodes_.size(), from, square, wanted);
        return square;
    }

private:
    /// Points of a leaf, which are visited one by one.
    /// Taste: a larger value saves memory and costs more distances a search.
    static constexpr size_t kLeaf = 8;

    struct PointNode {
        glm::dvec3 point;
        uint32_t number;
        uint32_t axis;  // the axis of the split, for the point in the middle of its range
    };

    void build(size_t begin, size_t end);

    template <typename Wanted>
    void search(size_t begin, size_t end, const glm::dvec3& from, double& square,
                const Wanted& wanted) const {
        if (end - begin <= kLeaf) {
            for (size_t i = begin; i < end; ++i)
                visit(nodes_[i], from, square, wanted);
            return;
        }
        const size_t middle = begin + (end - begin) / 2;
        const PointNode& node = nodes_[middle];
        const auto axis = static_cast<int>(node.axis);
        const double off = from[axis] - node.point[axis];
        // The other half is at least as far as the plane.
        for (const bool near : {true, false}) {
            if (!near && !(off * off < square))
                return;
            if ((off < 0) == near)
                search(begin, middle, from, square, wanted);
            else
                search(middle + 1, end, from, square, wanted);
            if (near)
                visit(node, from, square, wanted);
        }
    }

    template <typename Wanted>
    static void visit(const PointNode& node, const glm::dvec3& from, double& square,
                      const Wanted& wanted) {
        const glm::dvec3 arm = node.point - from;
        const double here = glm::dot(arm, arm);
        if (here < square && wanted(node.number))
            square = here;
    }

    std::vector<PointNode> nodes_;
};

}  // namespace lodestone::measure
