// SPDX-License-Identifier: GPL-3.0-or-later
// Part distances: how far a part of a mesh lies from what is left when it is removed.
#pragma once

#include "geometry/part_tree.h"
#include "simplify/collapse/collapse_mesh.h"

namespace lodestone::simplify {

/// The live triangles of a mesh whose parts are ranked.
class PartDistances {
public:
    /// `ranks`: by part.
    PartDistances(const CollapseMesh& mesh, std::span<const uint32_t> ranks);

    /// The squared distance from the farthest of the corners at which the part with a rank touches
    /// its box to the nearest triangle of a higher rank, in units of the mesh, but no more than the
    /// box's diagonal: what is smaller than an error is not missed, however far off it is. `least`
    /// where it is no more than that, which takes less time. cost: log n for each corner, if
    /// something is near.
    double farthest(uint32_t rank, double least) const;

private:
    /// Squared distances between which the nearest triangle is looked for.
    struct Limits {
        double enough;
        double most;
    };
    /// The squared distance from a place to the nearest triangle above a rank, `most` at most; it
    /// ends as soon as one is within `enough`.
    double nearest(const glm::vec3& place, uint32_t rank, const Limits& limits) const;

    Mesh live_;
    std::vector<uint32_t> ranks_;  // of the live triangles
    std::vector<uint32_t> first_;  // by rank: where its triangles begin in order_
    std::vector<uint32_t> order_;
    geometry::PartTree tree_;
    std::vector<uint32_t> highest_;  // the highest rank in a part of the tree
};

}  // namespace lodestone::simplify
