// SPDX-License-Identifier: GPL-3.0-or-later
// Pixel filter: pictures of which each pixel was sampled within its square, blurred as Cycles and
// Eevee blur theirs.
#pragma once

#include "image/image.h"

namespace lodestone::image {

/// The largest size of a filter, in pixels; larger ones count as this one.
/// Taste: nobody wants pictures that are more blurred; a larger value takes longer.
inline constexpr double kMostFilterSize = 10;

/// The variance, in square pixels, by which a Blackman-Harris filter of this size (Blender's Filter
/// Size, in pixels) spreads more than n x n samples in each pixel's square do. Nothing for a filter
/// that spreads less.
double missing_spread(double filter_size, int samples_along_side);

/// The pixels around a part of a picture that are needed to blur it by a variance.
int spread_reach(double variance);

/// Blurs a part of a picture of linear light with associated alpha by that variance, the same along
/// both axes. Nothing comes in from outside of the part. Values that are no numbers become 0.
void spread_pixels(Image& image, double variance, const ImageRegion& part);

}  // namespace lodestone::image
