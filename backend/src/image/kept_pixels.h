// SPDX-License-Identifier: GPL-3.0-or-later
// KeptPixels: while one lives, pictures stay decoded, for work that looks at each several times.
#pragma once

#include "image/packed_image.h"

#include <functional>

namespace lodestone::image {

/// Lets packed() remember, in any thread, what it decoded, until the last of these is gone.
class KeptPixels {
public:
    KeptPixels();
    ~KeptPixels();
    KeptPixels(const KeptPixels&) = delete;
    KeptPixels& operator=(const KeptPixels&) = delete;

    /// The most bytes of pixels, of which those used longest ago are forgotten first.
    /// Taste: a larger value decodes fewer pictures again in scenes that have very many.
    static constexpr size_t kMostBytes = size_t{256} << 20u;
};

/// The pixels of a picture: the kept ones, or what `decode` returns, which is kept if any
/// KeptPixels lives.
PackedPtr kept_pixels(const Picture& picture, const std::function<PackedPtr()>& decode);

}  // namespace lodestone::image
