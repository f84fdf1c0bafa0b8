// SPDX-License-Identifier: GPL-3.0-or-later
// TextureSampler: a texture's values at texture coordinates.
#pragma once

#include "image/decoded_texels.h"
#include "image/packed_image.h"
#include "image/texel_rows.h"

#include <glm/vec4.hpp>

namespace lodestone::image {

/// The decoded picture: linear color when its space is Srgb, else its numbers; straight alpha.
/// It takes four to sixteen times the memory of packed(). Throws as that.
Image decoded(const Picture& picture);

/// The largest file of a picture in bytes.
/// Taste: a larger value lets one picture file take more than 1 GiB of memory before it is decoded.
inline constexpr uint64_t kMostFileBytes = uint64_t{1} << 30u;

/// The picture of a file's bytes, proved to decode. The result of decoding is remembered by hash
/// for the life of the process, so a second time costs the hash only. Throws Error(BadFile) calling
/// it `name` when it is no PNG, JPEG or OpenEXR. May be called from any thread.
PicturePtr make_picture(std::string bytes, ColorSpace space, const std::string& name);
/// The picture of a PNG that is made of pixels of 8 bits, RGB or RGBA, and so is not decoded.
PicturePtr make_picture(const PackedImage& pixels, PngEffort effort, ColorSpace space,
                        const std::string& name);

/// The value of a texture for a texel: as a color, and where one number is wanted.
glm::dvec3 color_of(const Texture& texture, const glm::dvec4& texel);
double number_of(const Texture& texture, const glm::dvec4& texel);

/// A sampler that looks up the texels of one texture, reduced to at most `most_side` along a side
/// by averaging: for measuring, not for pictures. Threads may share it.
class TextureSampler {
public:
    /// The usual texels along a side.
    /// Taste: a larger value measures finer patterns, for memory that grows with its square.
    static constexpr int kMostSide = 1024;

    /// Without a picture every value is `otherwise`.
    TextureSampler(const Texture& texture, const glm::dvec3& otherwise, int most_side = kMostSide);
    /// Takes texels of the picture that others may share; null: as without a picture.
    TextureSampler(const Texture& texture, const glm::dvec3& otherwise, TexelsPtr texels);

    explicit operator bool() const { return texels_ != nullptr; }
    /// The values at texture coordinates.
    glm::dvec3 color(glm::dvec2 uv) const;
    double number(glm::dvec2 uv) const;
    /// The picture's own color and alpha at texture coordinates. There must be a picture.
    glm::dvec4 texel(glm::dvec2 uv) const;
    /// The texel of a column and row (0: the top one).
    glm::dvec4 at(int column, int row) const;
    int width() const { return texels_->width; }
    int height() const { return texels_->height; }

private:
    Texture texture_;
    glm::dvec3 otherwise_;
    TexelsPtr texels_;  // null: there is no picture
};

}  // namespace lodestone::image
