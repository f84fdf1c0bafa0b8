// SPDX-License-Identifier: GPL-3.0-or-later
// PackedImage: a picture with as many bits and channels as its file has; TexelRows unpacks its rows.
#pragma once

#include "image/image.h"
#include "model/picture.h"

#include <cstdint>
#include <memory>

namespace lodestone::image {

/// A picture as its file holds it, a quarter to a sixteenth of an Image. Moved, not copied.
struct PackedImage {
    int width = 0;
    int height = 0;
    int channels = 4;  // 1: gray; 2: gray and alpha; 3: RGB; 4: RGBA
    int depth = 8;     // bits of a channel: 8; 16, the higher byte first; 32: floats
    std::unique_ptr<unsigned char[]> bytes;  // of 8 and 16 bits, top row first
    std::vector<float> floats;               // RGBA in linear light, alpha associated (EXR)

    bool is_floats() const { return depth == 32; }
    size_t size() const { return static_cast<size_t>(width) * static_cast<size_t>(height); }
    /// The bytes of a row of 8 or 16 bits.
    size_t row_bytes() const {
        return static_cast<size_t>(width) * static_cast<size_t>(channels * depth / 8);
    }
    /// The bytes of all pixels.
    size_t memory() const {
        return is_floats() ? floats.size() * sizeof(float)
                           : row_bytes() * static_cast<size_t>(height);
    }
    const unsigned char* row(int y) const {
        return bytes.get() + static_cast<size_t>(y) * row_bytes();
    }
    unsigned char* row(int y) { return bytes.get() + static_cast<size_t>(y) * row_bytes(); }
};

/// A decoded picture that is shared; it never changes once made.
using PackedPtr = std::shared_ptr<const PackedImage>;

/// The picture as its file holds it, decoded once while any KeptPixels lives. Errors call it by its
/// name. Throws Error(BadFile).
PackedPtr packed(const Picture& picture);
/// Reads a picture from memory, as read() does and with its errors.
PackedImage read_packed(std::string_view bytes, const std::string& name);
/// Reads a picture file.
PackedImage read_packed(const std::filesystem::path& path);

/// The image in 8 bits, RGB where every alpha is 1, else RGBA; a linear image is display-encoded
/// first. Throws Error(InvalidArgument) for what is no image.
PackedImage packed(const Image& image);

/// A picture of that many bits, whose bytes are to be written. Throws Error(BadFile), before
/// anything is allocated, when it is empty or above kMostPixels.
PackedImage blank_packed(int64_t width, int64_t height, int channels, int depth,
                         const std::string& name);

/// The bytes of a PNG file of a picture of 8 bits, RGB or RGBA.
std::string png_bytes(const PackedImage& image, PngEffort effort);

/// The byte nearest to a number of 0...1; less and what is not a number is 0, more is 255.
inline unsigned char byte_of(float value) {
    const float scaled = 255.0f * (value > 0 ? (value < 1 ? value : 1.0f) : 0.0f);
    const int whole = static_cast<int>(scaled);
    // The difference is exact, and halves go up: the result of lround(), which is not inlined.
    return static_cast<unsigned char>(whole + (scaled - static_cast<float>(whole) >= 0.5f ? 1 : 0));
}

/// byte_of(encode_srgb(linear)), looked up.
unsigned char srgb_byte_of(float linear);

}  // namespace lodestone::image
