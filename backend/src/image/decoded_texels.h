// SPDX-License-Identifier: GPL-3.0-or-later
// DecodedTexels: decoded pictures, made small by averaging and shared, for measuring.
#pragma once

#include "base/recent_values.h"
#include "image/texel_rows.h"

#include <glm/vec4.hpp>

#include <memory>
#include <mutex>
#include <vector>

namespace lodestone::image {

/// The texels of a decoded picture.
struct DecodedTexels {
    int width = 0;
    int height = 0;
    std::vector<float> rgba;  // linear, straight alpha, top row first
    glm::dvec4 least{0.0};    // the least value of each channel
    bool reduced = false;     // true: fewer texels than the picture has
};

/// Shared texels; they never change once made.
using TexelsPtr = std::shared_ptr<const DecodedTexels>;

/// The texels of a picture with at most `most_side` along a side, each the mean of a block (colors
/// weighted by alpha). Throws Error(BadFile).
TexelsPtr texels_of(const Picture& picture, int most_side);
TexelsPtr texels_of(const TexelRows& rows, int most_side);

/// The texels of a texture with a cutoff: every channel is the share of the block where the
/// texture's number is at least `cutoff`. Means of the number itself would lose shapes thinner than
/// a block. Throws Error(BadFile).
TexelsPtr texels_with_cutoff(const Texture& texture, double cutoff, int most_side);

/// A cache that decodes every picture once, as long as all fit into `most_bytes`; the least used go
/// first. Texels in use elsewhere stay alive there. May be used from any thread; no answer depends
/// on the order.
class TexelCache {
public:
    explicit TexelCache(int most_side = 256, size_t most_bytes = size_t{256} << 20u)
        : most_side_(most_side), texels_(most_bytes) {}

    /// The texels of a texture; null where there is no picture or its bytes are not resident.
    /// Throws Error(BadFile).
    TexelsPtr of(const Texture& texture);
    TexelsPtr at_least(const Texture& texture, double cutoff);

    /// The bytes that the cache holds now.
    size_t bytes() const { return texels_.bytes(); }

private:
    template <typename Make>
    TexelsPtr find_or_make(Hash key, const Picture& picture, const Make& make);

    int most_side_;
    std::mutex one_large_;  // pictures are decoded as floats: not several huge ones at a time
    RecentValues<DecodedTexels> texels_;
};

}  // namespace lodestone::image
