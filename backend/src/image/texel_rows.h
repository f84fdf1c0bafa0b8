// SPDX-License-Identifier: GPL-3.0-or-later
// TexelRows: the texels of a packed picture row by row, so that no pass needs them all as floats.
#pragma once

#include "image/packed_image.h"
#include "model/texture.h"

#include <array>
#include <functional>

namespace lodestone::image {

/// A function of linear texels with straight alpha, one at a time, that is applied to rows.
struct TexelMap {
    /// One of `sources`: red, green and blue together.
    /// Law: no channel has this number.
    static constexpr int kColor = -1;

    std::function<void(float* rgba, size_t count)> apply;  // in place; none: they stay as they are
    /// The channel on which each channel of the result depends: those of pictures of 8 bits are
    /// looked up then, and apply() is called for the 256 bytes only.
    std::array<int, 4> sources{0, 1, 2, 3};
};

/// The map to what `value` makes of each channel of a texture's color; alpha stays.
TexelMap color_map(const Texture& texture, const std::function<float(double)>& value);
/// The map to what `value` makes of a texture's number, as an opaque gray.
TexelMap number_map(const Texture& texture, const std::function<float(double)>& value);

/// The rows of a picture, which must outlive it. Threads may share it.
class TexelRows {
public:
    /// Gives linear color when the space is Srgb, else the picture's numbers; of floats always
    /// linear color. Alpha is straight; what is not finite is 0. Then the map is applied.
    TexelRows(const PackedImage& image, ColorSpace space, TexelMap map = {});

    int width() const { return image_.width; }
    int height() const { return image_.height; }
    size_t size() const { return image_.size(); }
    /// Writes the texels of a row, 0 on top, as RGBA.
    void read(int y, float* rgba) const;

private:
    void look_up(const unsigned char* from, float* rgba) const;

    const PackedImage& image_;
    ColorSpace space_;
    TexelMap map_;
    std::vector<float> values_;       // 8 bits: 256 for each channel; none where they do not tell
    std::array<size_t, 4> places_{};  // the byte of a texel by which each channel is looked up
};

/// All rows as an image, which is called linear.
Image all_texels(const TexelRows& rows);
/// The picture's numbers.
Image unpacked(PackedImage&& image);
/// A picture file in linear light with associated alpha. Throws as read().
Image linear_picture(const std::filesystem::path& path);
/// All rows in 8 bits, RGB: alpha is left out.
PackedImage packed_colors(const TexelRows& rows);

}  // namespace lodestone::image
