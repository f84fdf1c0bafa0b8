// SPDX-License-Identifier: GPL-3.0-or-later
// ImageDifference: how far two pictures are apart over the covered pixels.
#pragma once

#include "image/image.h"

namespace lodestone::image {

/// The difference of two pictures. Values are display-encoded, 0...1, as a viewer shows them over
/// black (color times alpha), so that a wrong silhouette counts.
struct ImageDifference {
    double mean = 0;    // mean over pixels of the mean of |a - b| over R, G, B
    double p999 = 0;    // 99.9 % quantile (nearest rank) of the largest |a - b| of R, G, B
    double max = 0;     // the largest |a - b| of R, G, B
    double ssim = 1;    // mean structural similarity of luma, -1...1
    size_t pixels = 0;  // covered pixels; 0: all numbers above are as for equal pictures
};

/// Compares two pictures over the covered pixels: where the mask's alpha exceeds 1/255 (a mask that
/// is opaque everywhere covers everything); without a mask where either picture's alpha does. SSIM:
/// Rec.709 weights, 11x11 Gaussian of sigma 1.5 (normalized at the border), constants 0.01 and
/// 0.03, a map of all pixels averaged over the covered ones. The result is the same on any number
/// of threads. Throws Error(InvalidArgument) when sizes differ.
/// source: Wang et al. 2004, "Image Quality Assessment", eq. 13.
ImageDifference compare(const Image& a, const Image& b, const Image* mask = nullptr);

}  // namespace lodestone::image
