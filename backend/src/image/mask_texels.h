// SPDX-License-Identifier: GPL-3.0-or-later
// Mask texels: what a texture of alpha covers, texel by texel, and whether it is a mask at all.
#pragma once

#include "model/texture.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace lodestone::image {

/// The alpha of a picture's texels, in steps of 255, upper row first.
struct MaskTexels {
    int width = 0;
    int height = 0;
    std::vector<uint8_t> alpha;
    std::vector<uint8_t> edges = {};  // by texel: MaskCount::edge counts it; none: not found yet

    size_t size() const { return alpha.size(); }
};

/// The numbers of an alpha texture, clamped to 0...1. Throws Error(BadFile).
MaskTexels mask_texels(const Texture& texture);

/// The texels that a surface shows: a flag for each block of `side` x `side` texels, upper row
/// first.
struct SeenTexels {
    int side = 1;
    int columns = 0;
    int rows = 0;
    std::vector<uint8_t> blocks;
};

/// The blocks of a picture, none of them seen: at most kMostBlocks along a side.
SeenTexels unseen_texels(int width, int height);

/// The content of the texels that are seen.
struct MaskCount {
    size_t seen = 0;
    size_t sure = 0;        // below 0.1 or above 0.9
    size_t clear = 0;       // below 0.1
    size_t edge = 0;        // others with a sure one not more than two texels away
    double mean = 0;        // of the alpha
    double clear_mean = 0;  // of that of the clear ones; 0 without any
    double full_mean = 1;   // of that of those above 0.9; 1 without any
    double spread = 0;      // its variance, over that of an alpha of 0 and 1 with the same mean

    /// Whether the alpha says what is there rather than how clear it is: at least 95 % are sure, or
    /// 80 % are, together with needles and blurred edges, and the alpha varies as much as a mask's.
    /// Where next to all is clear, or next to none, it must be so in earnest: a film that is a
    /// little clear all over is no mask.
    bool is_mask() const;
};
MaskCount count(const MaskTexels& texels, const SeenTexels& seen);

/// The alpha, halved so often, as floats, and what of it is seen. `cutoff`: first every texel
/// becomes 1 where it is at least that, else 0.
struct MaskNumbers {
    int width = 0;
    int height = 0;
    std::vector<float> alpha;
};
MaskNumbers halved(const MaskTexels& texels, int halvings, std::optional<double> cutoff);
/// A flag for each texel of a picture of that size.
std::vector<uint8_t> seen_of(const SeenTexels& seen, const MaskTexels& texels, int width,
                             int height);

}  // namespace lodestone::image
