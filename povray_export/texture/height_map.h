// SPDX-License-Identifier: GPL-3.0-or-later
// Height map: the surface whose slopes a normal map holds, for renderers that know heights only.
#pragma once

#include "image/image.h"
#include "model/texture.h"

#include <memory>

namespace lodestone::povray {

/// A map of heights, of at most 1024 texels a side, a power of two.
struct HeightMap {
    int width = 0;
    int height = 0;
    std::vector<float> values;  // 0...1, top row first; it repeats
    double range = 0;           // the height that 1 stands for, in widths of a texel of this map
};

/// The height map of a tangent space normal map (0...1 for -1...1, green up): the heights with the
/// least squared difference of slopes (Frankot, Chellappa 1988). The newest maps are kept for the
/// next call. It may be called from any thread. Throws Error(BadFile).
std::shared_ptr<const HeightMap> height_map(const Texture& normals);

/// The PNG file whose gray in POV-Ray (0.297 R + 0.589 G + 0.114 B) is the height: the three
/// channels of 8 bits differ by at most one, which makes steps of a tenth of 1/255.
std::string png_of(const HeightMap& map);

}  // namespace lodestone::povray
