// SPDX-License-Identifier: GPL-3.0-or-later
// Corner rays: how many rays find the sky's light at each corner of a mesh.
#pragma once

#include <cstdint>
#include <vector>

namespace lodestone::povray {

/// The rays of each corner of a mesh by its triangles. Where all distinct meshes of a scene have
/// many triangles together, the largest ones have fewer rays, half of `rays` or a quarter ..., so
/// that all rays stay about as many; small ones, which are the large faces, have all of them.
class CornerRays {
public:
    /// `triangles`: of each distinct mesh of the scene, in any order.
    CornerRays(int rays, std::vector<uint64_t> triangles);
    int of(uint64_t triangles) const;

private:
    int rays_;
    double most_;  // rays times triangles of one mesh
};

}  // namespace lodestone::povray
