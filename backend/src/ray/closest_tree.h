// SPDX-License-Identifier: GPL-3.0-or-later
// ClosestTree: a tree of boxes over one mesh, four to a node, for closest points alone.
#pragma once

#include "ray/closest_search.h"

#include <glm/mat3x3.hpp>

#include <array>
#include <optional>
#include <vector>

namespace lodestone::ray {

/// Boxes and triangles in single precision only propose; the search decides in double, so that
/// answers do not depend on the tree.
class ClosestTree {
public:
    /// Positions lie in the unit sphere; triangles with a non-finite corner are left out. Of many
    /// with the same corners only the lowest counts, unless they are `unlike`. Keeps nothing of
    /// either.
    ClosestTree(const std::vector<glm::vec3>& positions, const std::vector<Triangle>& triangles,
                bool unlike);

    /// Lets the search visit what may be within `radius` of its point, whose coordinates are below
    /// 1e15. The search must be over the same mesh. Ends as soon as something is within `enough`.
    void search(ClosestSearch& search, double radius, double enough = 0) const;

    /// Of at most four triangles each.
    size_t leaves() const { return leaves_.size(); }

private:
    using Four = float __attribute__((vector_size(16)));
    static constexpr int kWidth = 4;

    struct WideNode {
        std::array<Four, 3> low, high;         // of the children; nothing is in an empty box
        std::array<int32_t, kWidth> children;  // a node, or ~ a leaf
    };
    struct TriangleLeaf {
        std::array<Four, 3> a, ab, ac;
        Four slack;  // how far its distance in single precision may be off
        std::array<uint32_t, kWidth> triangles;
    };
    struct TriangleReference {
        Four low, high;  // the fourth lane is not used
        uint32_t triangle;
    };
    struct ReferenceRange {
        size_t begin, end;
        int depth;
    };

    struct TreeGeometry {
        const std::vector<glm::vec3>& positions;
        const std::vector<glm::vec3>& turned;  // along the tree's axes
        const std::vector<Triangle>& triangles;
        bool unlike;
    };

    void make(const TreeGeometry& given);
    int32_t add(const TreeGeometry& given, std::vector<TriangleReference>& references,
                ReferenceRange range);
    int32_t add_leaf(const TreeGeometry& given, const std::vector<TriangleReference>& references,
                     ReferenceRange range);
    static std::optional<size_t> split(std::vector<TriangleReference>& references,
                                       ReferenceRange range);
    static size_t end_of_distinct(const TreeGeometry& given,
                                  std::vector<TriangleReference>& references, ReferenceRange range);
    static Four square_distances(const TriangleLeaf& leaf, const glm::vec3& point);

    std::optional<glm::dmat3> axes_;  // rows: the tree's; none: x, y, z
    std::vector<WideNode> nodes_;
    std::vector<TriangleLeaf> leaves_;
    int32_t root_ = 0;
    bool empty_ = true;
};

}  // namespace lodestone::ray
