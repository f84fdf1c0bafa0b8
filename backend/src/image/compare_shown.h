// SPDX-License-Identifier: GPL-3.0-or-later
// ShownDifferences: the things in which two pictures differ most, and where, in false colors.
#pragma once

#include "image/image.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace lodestone::image {

/// The number in a picture of identities where nothing is drawn.
/// Law: identities count from 1.
inline constexpr uint32_t kNothing = 0;

/// The linear color that marks thing number `i` in a picture of identities. It is exact in half
/// floats, for the first 2^24 - 1 things.
std::array<double, 3> identity_color(uint32_t i);

/// The identities of all pixels: 1 + the number of the thing that the pixel shows, or kNothing.
/// `marked` is a linear picture drawn in identity_color()s without antialiasing. Throws
/// Error(InvalidArgument) for a picture that is not linear.
std::vector<uint32_t> identities(const Image& marked);

/// Adds for each thing the sum, over the pixels that show it, of the mean over R, G, B of |a - b|
/// (display-encoded, over black). Pixels that show nothing, or a thing beyond `sums`, add to
/// nothing. Throws Error(InvalidArgument) when sizes differ.
void add_differences(const Image& a, const Image& b, const std::vector<uint32_t>& shown,
                     std::span<double> sums);

/// The false color of a difference of display values, linear: black at 0, blue at 0.02, green at
/// 0.05, yellow at 0.1, red at 0.25 and more.
std::array<float, 3> difference_color(float difference);

/// The picture of false colors, opaque and linear, of the largest |a - b| of R, G, B of each pixel.
/// Throws Error(InvalidArgument) when sizes differ.
Image difference_picture(const Image& a, const Image& b);

}  // namespace lodestone::image
