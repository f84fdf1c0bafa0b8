// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/texture_sampler.h"

#include "base/color.h"
#include "image/image_reduction.h"
#include "image/picture_findings.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace lodestone::image {
namespace {

PictureFormat format_of(std::string_view bytes) {
    using namespace std::string_view_literals;
    if (bytes.starts_with("\xff\xd8"sv))
        return PictureFormat::Jpeg;
    return bytes.starts_with("\x76\x2f"sv) ? PictureFormat::Exr : PictureFormat::Png;
}

/// The texel of a row of `size` texels that is looked up; -1: outside, clipped.
int64_t wrapped(int64_t at, int64_t size, TextureExtension extension) {
    if (at >= 0 && at < size)
        return at;
    switch (extension) {
        case TextureExtension::Extend:
            return std::clamp<int64_t>(at, 0, size - 1);
        case TextureExtension::Clip:
            return -1;
        case TextureExtension::Mirror: {
            const int64_t twice = ((at % (2 * size)) + 2 * size) % (2 * size);
            return twice < size ? twice : 2 * size - 1 - twice;
        }
        case TextureExtension::Repeat:
            break;
    }
    return ((at % size) + size) % size;
}

double pick(TextureChannel channel, const glm::dvec4& texel) {
    switch (channel) {
        case TextureChannel::Red:
            return texel.x;
        case TextureChannel::Green:
            return texel.y;
        case TextureChannel::Blue:
            return texel.z;
        case TextureChannel::Alpha:
            return texel.w;
        case TextureChannel::Color:
        case TextureChannel::Luma:
            break;
    }
    return luminance(glm::dvec3(texel));
}

PictureFacts facts_of(const PackedImage& image, ColorSpace space) {
    return {image.width, image.height, mean_of(TexelRows(image, space))};
}

/// The picture of a file's bytes, of which the pixels are known, or none.
PicturePtr picture_of(std::string bytes, const PackedImage* pixels, ColorSpace space,
                      const std::string& name) {
    auto picture = std::make_shared<Picture>();
    picture->name = name;
    picture->space = space;
    picture->hash = Hasher().text(bytes).value(space).result();
    picture->bytes = std::move(bytes);
    picture->format = format_of(picture->bytes);
    std::optional<PictureFacts> facts = known_facts(picture->hash);
    if (!facts) {
        facts = facts_of(pixels != nullptr ? *pixels : *packed(*picture), space);
        add_facts(picture->hash, *facts);
    }
    picture->width = facts->width;
    picture->height = facts->height;
    picture->mean = facts->mean;
    return picture;
}

}  // namespace

Image decoded(const Picture& picture) {
    const PackedPtr image = packed(picture);
    return all_texels(TexelRows(*image, picture.space));
}

PicturePtr make_picture(std::string bytes, ColorSpace space, const std::string& name) {
    return picture_of(std::move(bytes), nullptr, space, name);
}

PicturePtr make_picture(const PackedImage& pixels, PngEffort effort, ColorSpace space,
                        const std::string& name) {
    return picture_of(png_bytes(pixels, effort), &pixels, space, name);
}

glm::dvec3 color_of(const Texture& texture, const glm::dvec4& texel) {
    if (texture.channel == TextureChannel::Color)
        return texture.offset + texture.scale * glm::dvec3(texel);
    return texture.offset + texture.scale * pick(texture.channel, texel);
}

double number_of(const Texture& texture, const glm::dvec4& texel) {
    return texture.offset.x + texture.scale.x * pick(texture.channel, texel);
}

TextureSampler::TextureSampler(const Texture& texture, const glm::dvec3& otherwise, int most_side)
    : TextureSampler(texture, otherwise,
                     texture ? texels_of(*texture.picture, most_side) : nullptr) {}

TextureSampler::TextureSampler(const Texture& texture, const glm::dvec3& otherwise,
                               TexelsPtr texels)
    : texture_(texture), otherwise_(otherwise), texels_(std::move(texels)) {
    if (texels_ && texels_->rgba.empty())
        texels_ = nullptr;
}

glm::dvec4 TextureSampler::at(int column, int row) const {
    const float* from =
        texels_->rgba.data() + 4 * (static_cast<size_t>(row) * static_cast<size_t>(texels_->width) +
                                    static_cast<size_t>(column));
    return {from[0], from[1], from[2], from[3]};
}

glm::dvec4 TextureSampler::texel(glm::dvec2 uv) const {
    const int width = texels_->width;
    const int height = texels_->height;
    glm::dvec2 at = to_picture(texture_, uv);
    if (!std::isfinite(at.x) || !std::isfinite(at.y))
        at = glm::dvec2(0);
    // Texels cannot be told apart far away, and the numbers must fit.
    at = glm::clamp(at, -1e6, 1e6);
    const bool closest = texture_.interpolation == TextureInterpolation::Closest;
    const double shift = closest ? 0 : 0.5;
    const double x = at.x * width - shift;
    const double y = (1 - at.y) * height - shift;
    const double left = std::floor(x);
    const double top = std::floor(y);
    const int64_t columns[] = {wrapped(static_cast<int64_t>(left), width, texture_.extension),
                               wrapped(static_cast<int64_t>(left) + 1, width, texture_.extension)};
    const int64_t rows[] = {wrapped(static_cast<int64_t>(top), height, texture_.extension),
                            wrapped(static_cast<int64_t>(top) + 1, height, texture_.extension)};
    glm::dvec4 sum(0.0);
    for (int corner = 0; corner < (closest ? 1 : 4); ++corner) {
        const int right = corner & 1;
        const int low = corner >> 1;
        const double weight =
            closest ? 1.0
                    : (right != 0 ? x - left : left + 1 - x) * (low != 0 ? y - top : top + 1 - y);
        const int64_t column = columns[right];
        const int64_t row = rows[low];
        if (column < 0 || row < 0)
            continue;
        sum += weight * this->at(static_cast<int>(column), static_cast<int>(row));
    }
    return sum;
}

glm::dvec3 TextureSampler::color(glm::dvec2 uv) const {
    return texels_ ? color_of(texture_, texel(uv)) : otherwise_;
}

double TextureSampler::number(glm::dvec2 uv) const {
    return texels_ ? number_of(texture_, texel(uv)) : otherwise_.x;
}

}  // namespace lodestone::image
