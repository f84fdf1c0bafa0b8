// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/lamp/corner_rays.h"

#include <algorithm>

namespace lodestone::povray {
namespace {

// Distinct triangles from which on corners of the largest meshes have fewer rays each.
// Taste: a larger value has less noise in large scenes, whose bake takes longer than their files.
constexpr double kFullTriangles = 300'000;
// The same for each pixel of the picture.
// Taste: a larger value has less noise where many triangles share a pixel, for more rays than the
// picture itself has.
constexpr double kFullOfPixel = 1;
constexpr int kFewestCornerRays = 16;  // Taste: as kFullTriangles

}  // namespace

CornerRays::CornerRays(int rays, std::vector<uint64_t> triangles, double pixels)
    : rays_(rays), most_(kInfinity) {
    // The others have the rays that small meshes do not need.
    std::sort(triangles.begin(), triangles.end());
    double left = std::min(kFullTriangles, kFullOfPixel * pixels) * rays;
    for (size_t i = 0; i < triangles.size(); ++i) {
        const double each = left / static_cast<double>(triangles.size() - i);
        const double wanted = static_cast<double>(triangles[i]) * rays;
        if (wanted > each) {
            most_ = each;
            return;
        }
        left -= wanted;
    }
}

int CornerRays::of(uint64_t triangles) const {
    int rays = rays_;
    while (rays / 2 >= kFewestCornerRays && static_cast<double>(triangles) * rays > most_)
        rays /= 2;  // so that a thing more changes the rays of few others
    return rays;
}

}  // namespace lodestone::povray
