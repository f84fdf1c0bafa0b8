// SPDX-License-Identifier: GPL-3.0-or-later
// Corner rays: how many rays find the sky's light at each corner of a mesh.
#pragma once

#include "base/maths.h"

#include <cstdint>
#include <vector>

namespace lodestone::povray {

/// The rays of each corner of a mesh by its triangles that are seen. Where all distinct meshes
/// together show more triangles than a picture has pixels, or very many, the largest ones have fewer
/// rays, half of `rays` or a quarter ..., so that all rays stay about as many; small ones, which are
/// the large faces, have all of them.
class CornerRays {
public:
    /// `triangles`: those that are seen of each distinct mesh, in any order.
    CornerRays(int rays, std::vector<uint64_t> triangles, double pixels = kInfinity);
    int of(uint64_t triangles) const;

private:
    int rays_;
    double most_;  // rays times triangles of one mesh
};

}  // namespace lodestone::povray
