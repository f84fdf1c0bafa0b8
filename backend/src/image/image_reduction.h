// SPDX-License-Identifier: GPL-3.0-or-later
// Image reduction: pictures of fewer texels, each the mean of those that it covers.
#pragma once

#include "image/texel_rows.h"

#include <glm/vec4.hpp>

namespace lodestone::image {

/// The image with at most as many texels along its sides, each the mean of a block. Colors are
/// weighted by alpha, which must be straight, but where all of a block is clear: what nobody sees,
/// often black or white, does not fringe what is seen.
Image reduced(const Image& from, int width, int height);
/// The same of rows, which are read one after the other. The image is called linear.
Image reduced(const TexelRows& from, int width, int height);

/// The mean of all texels, by the same weights.
glm::dvec4 mean_of(const TexelRows& rows);

/// Gives texels that are clear, or nearly, the color of what is around them, and no alpha: the mean
/// of the smallest of blocks, each of four smaller ones, in which something is there.
void spread_into_clear(Image& image);

}  // namespace lodestone::image
