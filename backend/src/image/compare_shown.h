// SPDX-License-Identifier: GPL-3.0-or-later
// Compare by what is shown: which things two pictures differ in most, and where, in false colors.
#pragma once

#include "image/image.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace lodestone::image {

/// What a picture of identities shows where nothing is.
inline constexpr uint32_t kNothing = 0;

/// The linear color that marks thing number `i` in a picture of identities. Exact in half floats,
/// for the first 2^24 - 1.
std::array<double, 3> identity_color(uint32_t i);

/// Of each pixel 1 + the number of the thing it shows, or kNothing. `marked` is a linear picture
/// drawn in identity_color()s without antialiasing. Throws Error(InvalidArgument) for one that is
/// not linear.
std::vector<uint32_t> identities(const Image& marked);

/// Adds for each thing the sum, over the pixels that show it, of the mean over R, G, B of |a - b|
/// (display-encoded, over black). Pixels that show nothing, or a thing beyond `sums`, add to
/// nothing. Throws Error(InvalidArgument) when sizes differ.
void add_differences(const Image& a, const Image& b, const std::vector<uint32_t>& shown,
                     std::span<double> sums);

/// Of a difference of display values: black 0, blue .02, green .05, yellow .1, red .25 and more;
/// linear.
std::array<float, 3> difference_color(float difference);

/// Opaque and linear; of the largest |a - b| of R, G, B of each pixel. Throws as above.
Image difference_picture(const Image& a, const Image& b);

}  // namespace lodestone::image
