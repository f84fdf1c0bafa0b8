// SPDX-License-Identifier: GPL-3.0-or-later
// Seen sides: which triangles of a surface a picture sees from behind.
#pragma once

#include "model/model.h"

#include <optional>
#include <span>
#include <vector>

namespace lodestone::povray {

/// The sides that a picture sees of one surface, at all of its placements together.
class SeenSides {
public:
    /// Adds a placement. `seen`: by triangle, bits of light::SeenParts; empty: it is not known what
    /// is seen, and backs count as seen where the mesh is open.
    void add(const Mesh& mesh, const Affine& world, const Bound& bound, const Camera& camera,
             std::span<const uint8_t> seen);
    /// By triangle, 1: more is seen of its back than of its front. Empty: of none.
    std::vector<uint8_t> behind() const;

private:
    bool closed(const Mesh& mesh);

    std::vector<float> fronts_;  // by triangle: what is seen of it, less what is seen of its back
    std::optional<bool> closed_;
};

}  // namespace lodestone::povray
