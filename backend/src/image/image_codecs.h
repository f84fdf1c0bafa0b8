// SPDX-License-Identifier: GPL-3.0-or-later
// Image codecs: one function a file format; seen only inside the image floor.
#pragma once

#include "image/image.h"

#include <optional>

namespace lodestone::image {

/// The decoders take a file's bytes; `name` is what errors call it. Throw Error(BadFile).
Image decode_png(std::string_view bytes, const std::string& name);
Image decode_jpeg(std::string_view bytes, const std::string& name);
/// Decodes all of a picture of at most kMostPixels, or the part.
Image decode_exr(std::string_view bytes, const std::string& name,
                 const std::optional<ImageRegion>& part = std::nullopt);

/// The bytes of a PNG file. `rows` holds height rows of width * channels bytes; 3 or 4 channels.
std::string encode_png(const std::vector<unsigned char>& rows, int width, int height, int channels,
                       PngEffort effort);

/// An image of that size, all 0. Throws Error(BadFile) when it is empty or above kMostPixels.
Image blank_image(int64_t width, int64_t height, bool linear, const std::string& name);

}  // namespace lodestone::image
