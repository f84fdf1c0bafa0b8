// SPDX-License-Identifier: GPL-3.0-or-later
// Image: pictures as floats; PNG, JPEG and OpenEXR are read, PNG and OpenEXR are written.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace lodestone::image {

/// A picture with more pixels is refused before anything is allocated (8192 x 8192).
/// Taste: a larger value lets one picture take more than 1 GiB (16 bytes a pixel).
inline constexpr size_t kMostPixels = size_t{1} << 26u;

/// A picture in memory.
struct Image {
    int width = 0;
    int height = 0;
    bool linear = false;        // linear light, alpha associated (EXR); else sRGB 0...1, straight
    std::vector<float> pixels;  // RGBA, 4 * width * height, top row first

    size_t size() const { return static_cast<size_t>(width) * static_cast<size_t>(height); }
};

/// A rectangle of pixels, from the picture's upper left corner.
struct ImageRegion {
    int left = 0;
    int top = 0;
    int width = 0;
    int height = 0;
};

/// Reads a picture, whose kind is told by the first bytes. PNG: every color type and depth; JPEG:
/// gray and RGB; OpenEXR: R, G, B, A or Y of a flat picture, of which the display window is read (0
/// outside the data window). Missing alpha is 1. Throws Error(Io) or Error(BadFile) with a sentence
/// naming the file.
Image read(const std::filesystem::path& path);
/// Reads a picture from memory; `name` is what errors call it.
Image read(std::string_view bytes, const std::string& name);
/// Reads a part of an OpenEXR picture. The picture may have more than kMostPixels, and so may the
/// part: memory is taken for the part alone. Throws as read(), and Error(InvalidArgument) for a
/// part that is not within the picture.
Image read_region(const std::filesystem::path& path, const ImageRegion& part);

/// Writes 8 bits a channel, RGB when every alpha is 1, else RGBA; a linear image is encoded first.
/// The file is written whole or not at all.
void write_png(const std::filesystem::path& path, const Image& image);
/// The thing that is spared when a PNG file is made.
enum class PngEffort : uint8_t {
    Small,  // bytes: for files that are kept
    Quick,  // time: nothing is compressed, for what is read soon
};
/// The bytes of such a PNG file. Throws Error(InvalidArgument).
std::string png_bytes(const Image& image, PngEffort effort = PngEffort::Small);

/// The bytes of an OpenEXR file of linear light with associated alpha, 16 bits a channel, RGBA;
/// values beyond 65504 become that. Throws Error(InvalidArgument) for an image that is not linear.
std::string exr_bytes(const Image& image);

/// The image for a display: linear with associated alpha becomes sRGB with straight alpha, clamped
/// to 0...1 (not a number: 0); another image stays as it is.
Image encoded(const Image& image);

}  // namespace lodestone::image
