// SPDX-License-Identifier: GPL-3.0-or-later
// Image: pictures as floats; reading PNG, JPEG and OpenEXR, writing PNG.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace lodestone::image {

/// More pixels than this are refused before anything is allocated (2^26: 8192 x 8192, 1 GiB).
inline constexpr size_t kMostPixels = size_t{1} << 26u;

struct Image {
    int width = 0;
    int height = 0;
    bool linear = false;        // linear light, alpha associated (EXR); else sRGB 0...1, straight
    std::vector<float> pixels;  // RGBA, 4 * width * height, top row first

    size_t size() const { return static_cast<size_t>(width) * static_cast<size_t>(height); }
};

/// Pixels of a picture, from its upper left corner.
struct ImageRegion {
    int left = 0;
    int top = 0;
    int width = 0;
    int height = 0;
};

/// The kind is told by the first bytes. PNG: every color type and depth; JPEG: gray and RGB;
/// OpenEXR: R, G, B, A or Y of a flat picture, the display window of it (outside the data window:
/// 0). Missing alpha is 1. Throws Error(Io) or Error(BadFile) with a sentence naming the file.
Image read(const std::filesystem::path& path);
/// The same from memory; `name` is what errors call it.
Image read(std::string_view bytes, const std::string& name);
/// A part of an OpenEXR picture, which may have more than kMostPixels, as may the part: memory is
/// taken for that alone. Throws as read() and Error(InvalidArgument) for what is not within it.
Image read_region(const std::filesystem::path& path, const ImageRegion& part);

/// 8 bit, RGB when every alpha is 1, else RGBA; a linear image is encoded first. All or nothing.
void write_png(const std::filesystem::path& path, const Image& image);
/// The same, as the file's bytes. Throws Error(InvalidArgument).
std::string png_bytes(const Image& image);

/// Linear, associated -> sRGB, straight, clamped to 0...1 (not a number: 0); else the same image.
Image encoded(const Image& image);

/// The sRGB transfer functions (IEC 61966-2-1), for 0...1.
float encode_srgb(float linear);
float decode_srgb(float encoded);

}  // namespace lodestone::image
