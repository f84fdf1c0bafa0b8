// SPDX-License-Identifier: GPL-3.0-or-later
// PartTree: the triangles of a mesh in nested parts, each of which lies in a box.
#pragma once

#include "model/mesh.h"

#include <span>
#include <vector>

namespace lodestone::geometry {

/// A part of a mesh; its first half follows in the list, then its second one.
struct MeshPart {
    Box3 box;
    uint32_t begin = 0;  // of the tree's order
    uint32_t end = 0;    // of the tree's order
    uint32_t next = 0;   // the part after this one and all of its halves
};

/// Halves a mesh by the middles of its triangles, along the longest side of their box, down to a
/// few triangles. The same mesh gives the same tree. cost: n log n of the triangles.
class PartTree {
public:
    /// The most triangles of a part that is not halved.
    /// Taste: a larger value asks less often, and treats more alike.
    static constexpr size_t kFewTogether = 8;

    explicit PartTree(const Mesh& mesh);

    /// In depth-first order, the whole mesh first; none for a mesh without triangles.
    const std::vector<MeshPart>& parts() const { return parts_; }
    /// Whether a part is not halved.
    bool leaf(size_t part) const { return parts_[part].next == part + 1; }
    /// The triangles of a part, by their numbers.
    std::span<const uint32_t> triangles(const MeshPart& part) const {
        return std::span(order_).subspan(part.begin, part.end - part.begin);
    }

private:
    struct TriangleBoxes {
        std::span<const Box3> boxes;
        std::span<const glm::dvec3> middles;
    };
    Box3 add(const TriangleBoxes& given, uint32_t begin, uint32_t end);

    std::vector<MeshPart> parts_;
    std::vector<uint32_t> order_;
};

}  // namespace lodestone::geometry
