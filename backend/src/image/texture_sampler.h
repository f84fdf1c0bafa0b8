// SPDX-License-Identifier: GPL-3.0-or-later
// TextureSampler: a texture's values at texture coordinates.
#pragma once

#include "image/decoded_texels.h"
#include "image/image.h"

#include <glm/vec4.hpp>

namespace lodestone::image {

/// A picture, decoded: linear color when its space is Srgb, else its numbers; straight alpha.
/// `name` of errors is the picture's. Throws Error(BadFile).
Image decoded(const Picture& picture);

/// No file of a picture is larger.
inline constexpr uint64_t kMostFileBytes = uint64_t{1} << 30u;

/// A picture of a file's bytes, proved to decode. What decoding told is remembered by hash for the
/// life of the process, so a second time costs the hash only. Throws Error(BadFile) calling it
/// `name` when it is no PNG, JPEG or OpenEXR. Any thread.
PicturePtr make_picture(std::string bytes, ColorSpace space, const std::string& name);

/// A texture's value for a texel: color, and where one number is wanted.
glm::dvec3 color_of(const Texture& texture, const glm::dvec4& texel);
double number_of(const Texture& texture, const glm::dvec4& texel);

/// Looks up the texels of one texture, reduced to at most `most_side` a side by averaging: for
/// measuring, not for pictures. Threads may share it.
class TextureSampler {
public:
    static constexpr int kMostSide = 1024;

    /// Without a picture every value is `otherwise`.
    TextureSampler(const Texture& texture, const glm::dvec3& otherwise, int most_side = kMostSide);
    /// With texels of its picture that others may share; null: as without a picture.
    TextureSampler(const Texture& texture, const glm::dvec3& otherwise, TexelsPtr texels);

    explicit operator bool() const { return texels_ != nullptr; }
    glm::dvec3 color(glm::dvec2 uv) const;
    double number(glm::dvec2 uv) const;
    /// The picture's own color and alpha there. There must be a picture.
    glm::dvec4 texel(glm::dvec2 uv) const;
    /// The texel of a column and row (0: the top one).
    glm::dvec4 at(int column, int row) const;
    int width() const { return texels_->width; }
    int height() const { return texels_->height; }

private:
    Texture texture_;
    glm::dvec3 otherwise_;
    TexelsPtr texels_;  // null: none
};

}  // namespace lodestone::image
