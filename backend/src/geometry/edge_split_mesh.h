// SPDX-License-Identifier: GPL-3.0-or-later
// EdgeSplitMesh: a mesh some of whose edges are split at their middles, without gaps.
#pragma once

#include "model/mesh.h"

#include <span>
#include <vector>

namespace lodestone::geometry {

/// An edge by the two welded vertices at its ends (see weld()), the lower one first.
using WeldedEdge = uint64_t;
WeldedEdge welded_edge(uint32_t a, uint32_t b);

/// A mesh that is drawn as before, by more triangles. All triangles at a split edge are split
/// there, across seams too. The same splits give the same mesh.
class EdgeSplitMesh {
public:
    /// Throws Error(InvalidArgument) as check() does.
    explicit EdgeSplitMesh(const Mesh& mesh);

    const Mesh& mesh() const { return mesh_; }
    Mesh take() { return std::move(mesh_); }
    /// For each vertex the lowest vertex at the same position.
    const std::vector<uint32_t>& welded() const { return welded_; }
    /// The edge of a triangle from its corner to the next one.
    WeldedEdge edge(size_t triangle, int corner) const;

    /// Splits edges, which are rising; what is no edge of the mesh changes nothing. Returns for
    /// each triangle the one that it is or is a part of; parts lie one behind the other.
    std::vector<uint32_t> split(std::span<const WeldedEdge> edges);
    /// The triangles that there would be after these splits.
    size_t triangles_after(std::span<const WeldedEdge> edges) const;

private:
    bool splits(std::span<const WeldedEdge> edges, size_t triangle, int corner) const;

    Mesh mesh_;
    std::vector<uint32_t> welded_;
};

}  // namespace lodestone::geometry
