// SPDX-License-Identifier: GPL-3.0-or-later
// Seen sides: how large a picture sees the triangles of a surface, and which from behind.
#pragma once

#include "model/model.h"

#include <optional>
#include <span>
#include <vector>

namespace lodestone::povray {

/// The sides that a picture sees of one surface, at all of its placements together.
class SeenSides {
public:
    /// Adds a placement. `pixels`: those of the picture. `seen`: by triangle, bits of
    /// light::SeenParts; empty: it is not known what is seen, and backs count as seen where the mesh
    /// is open.
    void add(const Mesh& mesh, const Affine& world, const Camera& camera, double pixels,
             std::span<const uint8_t> seen);
    /// Whether anything was added that is not closed, or of which it is known what is seen.
    bool known() const { return !sizes_.empty(); }
    /// Tells the sizes of what is seen: `seen`, by triangle, are bytes of light::SkyShares::seen, which
    /// become those of the most pixels that one placement covers. False: they are not known.
    bool add_sizes(std::span<uint8_t> seen) const;
    /// By triangle, 1: more is seen of its back than of its front. Empty: of none.
    std::vector<uint8_t> behind() const;

private:
    bool closed(const Mesh& mesh);

    std::vector<float> fronts_;  // by triangle: pixels of its front, less those of its back
    std::vector<float> sizes_;
    std::optional<bool> closed_;
};

}  // namespace lodestone::povray
