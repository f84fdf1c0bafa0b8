// SPDX-License-Identifier: GPL-3.0-or-later
// Image codecs: one function a file format; seen only inside the image floor.
#pragma once

#include "image/packed_image.h"
#include "image/picture_size.h"

#include <optional>

namespace lodestone::image {

/// The decoders take a file's bytes; `name` is what errors call it. Throw Error(BadFile).
PackedImage decode_png(std::string_view bytes, const std::string& name);
PackedImage decode_jpeg(std::string_view bytes, const std::string& name);
/// The same of the file's header alone.
PictureSize png_size(std::string_view bytes, const std::string& name);
PictureSize jpeg_size(std::string_view bytes, const std::string& name);
/// Decodes all of a picture of at most kMostPixels, or the part.
PackedImage decode_exr(std::string_view bytes, const std::string& name,
                       const std::optional<ImageRegion>& part = std::nullopt);

/// The bytes of a PNG file of a picture of 8 bits and 3 or 4 channels.
std::string encode_png(const PackedImage& image, PngEffort effort);

}  // namespace lodestone::image
