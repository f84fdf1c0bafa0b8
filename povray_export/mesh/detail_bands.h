// SPDX-License-Identifier: GPL-3.0-or-later
// Detail bands: a mesh that reaches from near to far, or out of the picture, need not be as fine
// everywhere as at its finest place.
#pragma once

#include "base/hash.h"
#include "model/mesh.h"

#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace lodestone::povray {

/// A part of a mesh; its first half follows in the list, then its second one.
struct BandNode {
    glm::vec3 low{0.0f};
    glm::vec3 high{0.0f};
    uint32_t next = 0;     // the node after this one and all of its parts
    uint32_t octaves = 0;  // the fewest of them
};

/// The octaves by which parts of a mesh may be coarser: twice as coarse is one octave.
class DetailBands {
public:
    /// Gives the size of what must be told apart on a few triangles (by their numbers) within a
    /// bound: mesh frame; any unit; above 0.
    using PixelOfPart = std::function<double(const Bound&, std::span<const uint32_t>)>;

    /// Asks `pixel` for parts of the mesh. cost: n log n of the triangles.
    DetailBands(const Mesh& mesh, const PixelOfPart& pixel);

    /// The least size; infinite for a mesh without triangles.
    double finest() const { return finest_; }
    /// Whether all of the mesh has no octave.
    bool even() const { return nodes_.empty(); }
    /// The octaves of whatever lies in a box (mesh frame), such as a part of a triangle: the fewest
    /// of all parts of the mesh that reach into it. 0 where there are none.
    int octaves(const Box3& box) const;
    Hash hash() const { return hash_; }

    /// The most octaves.
    /// Taste: from a decimetre before the eye to the horizon.
    static constexpr int kMost = 16;

private:
    std::vector<BandNode> nodes_;  // in depth-first order
    double finest_;
    Hash hash_ = 0;
};
using DetailBandsPtr = std::shared_ptr<const DetailBands>;

}  // namespace lodestone::povray
