// SPDX-License-Identifier: GPL-3.0-or-later
// ClosestTree: a tree of boxes over one mesh, four to a node, for closest points alone.
// Our own although Embree has a point query: it finds 1.4 to 2 times as many closest points a
// second (million a second and core: skull 0.61 instead of 0.42, book 0.36 instead of 0.19), and a
// scene that is asked for closest points alone builds no tree of Embree's. Along a mesh's own axes
// it became 1.1 to 3.2 times faster again, and 10 times on thin sheets that stand askew (the book).
#pragma once

#include "ray/closest_search.h"

#include <glm/mat3x3.hpp>

#include <array>
#include <optional>
#include <vector>

namespace lodestone::ray {

/// The tree of one mesh. Boxes and triangles in single precision only propose; the search decides
/// in double precision, so that answers do not depend on the tree. Const methods may be called from
/// any thread.
class ClosestTree {
public:
    /// Positions lie in the unit sphere; triangles with a non-finite corner are left out. Among
    /// triangles with the same corners only the lowest counts, unless they are `unlike`. Keeps no
    /// reference.
    ClosestTree(const std::vector<glm::vec3>& positions, const std::vector<Triangle>& triangles,
                bool unlike);

    /// Lets the search visit the triangles that may lie within `radius` of its point, whose
    /// coordinates are below 1e15. The search must be over the same mesh. It ends as soon as
    /// something is within `enough`.
    void search(ClosestSearch& search, double radius, double enough = 0) const;

    /// The number of leaves, which have at most four triangles each.
    size_t leaves() const { return leaves_.size(); }

private:
    using Four = float __attribute__((vector_size(16)));
    /// Law: single-precision numbers in a register of 16 bytes, which every x86-64 processor has.
    static constexpr int kWidth = 4;

    struct WideNode {
        std::array<Four, 3> low, high;         // bounds of the children; an empty box holds nothing
        std::array<int32_t, kWidth> children;  // a node, or ~ a leaf
    };
    struct TriangleLeaf {
        std::array<Four, 3> a, ab, ac;
        Four slack;  // how far a distance in single precision may be off
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
        const std::vector<glm::vec3>& turned;  // the positions along the tree's axes
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

    std::optional<glm::dmat3> axes_;  // rows are the tree's axes; none: x, y, z
    std::vector<WideNode> nodes_;
    std::vector<TriangleLeaf> leaves_;
    int32_t root_ = 0;
    bool empty_ = true;
};

}  // namespace lodestone::ray
