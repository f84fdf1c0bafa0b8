// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/texture_sampler.h"

#include "base/color.h"
#include "base/error.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <unordered_map>

namespace lodestone::image {
namespace {

glm::dvec4 mean_of(const float* texels, size_t count) {
    glm::dvec4 sum(0.0);
    glm::dvec3 plain(0.0);
    for (size_t i = 0; i < count; ++i, texels += 4) {
        const glm::dvec3 color(texels[0], texels[1], texels[2]);
        const auto alpha = static_cast<double>(texels[3]);
        sum += glm::dvec4(alpha * color, alpha);
        plain += color;
    }
    if (count == 0)
        return sum;
    const auto total = static_cast<double>(count);
    return {sum.w > 0 ? glm::dvec3(sum) / sum.w : plain / total, sum.w / total};
}

PictureFormat format_of(std::string_view bytes) {
    using namespace std::string_view_literals;
    if (bytes.starts_with("\xff\xd8"sv))
        return PictureFormat::Jpeg;
    return bytes.starts_with("\x76\x2f"sv) ? PictureFormat::Exr : PictureFormat::Png;
}

/// The texel of a row of `size` texels that is looked up; -1: outside, clipped.
int64_t wrapped(int64_t at, int64_t size, TextureExtension extension) {
    switch (extension) {
        case TextureExtension::Extend:
            return std::clamp<int64_t>(at, 0, size - 1);
        case TextureExtension::Clip:
            return at >= 0 && at < size ? at : -1;
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

/// The facts about a picture that only decoding tells.
struct PictureFacts {
    PictureFormat format = PictureFormat::Png;
    int width = 0;
    int height = 0;
    glm::dvec4 mean{0.0};
};

PictureFacts facts_of(const Picture& picture) {
    const Image image = decoded(picture);
    PictureFacts facts;
    facts.format = format_of(picture.bytes);
    facts.width = image.width;
    facts.height = image.height;
    facts.mean = mean_of(image.pixels.data(), image.size());
    return facts;
}

/// decode_srgb(), whose values for 8 bits, which nearly all pictures have, are looked up.
float decode_srgb_texel(float encoded) {
    // Law: decode_srgb() of each byte.
    static const std::array<float, 256> kOfByte = [] {
        std::array<float, 256> out{};
        for (size_t i = 0; i < out.size(); ++i)
            out[i] = decode_srgb(static_cast<float>(i) / 255.0f);
        return out;
    }();
    if (encoded >= 0 && encoded <= 1) {
        // Law: a byte comes back as its number or a little less.
        const auto byte = static_cast<size_t>(encoded * 255.0f + 0.25f);
        if (static_cast<float>(byte) / 255.0f == encoded)
            return kOfByte[byte];
    }
    return decode_srgb(encoded);
}

}  // namespace

Image decoded(const Picture& picture) {
    Image image = read(picture.bytes, picture.name);
    if (image.linear) {  // colors of an EXR are times alpha
        for (size_t i = 0; i < image.pixels.size(); i += 4) {
            const float alpha = image.pixels[i + 3];
            if (alpha > 0 && alpha != 1) {
                for (size_t c = 0; c < 3; ++c)
                    image.pixels[i + c] /= alpha;
            }
        }
    } else if (picture.space == ColorSpace::Srgb) {
        for (size_t i = 0; i < image.pixels.size(); i += 4) {
            for (size_t c = 0; c < 3; ++c)
                image.pixels[i + c] = decode_srgb_texel(image.pixels[i + c]);
        }
    }
    image.linear = true;
    for (float& value : image.pixels) {
        if (!std::isfinite(value))
            value = 0;
    }
    return image;
}

PicturePtr make_picture(std::string bytes, ColorSpace space, const std::string& name) {
    static std::mutex mutex;
    static std::unordered_map<Hash, PictureFacts> known;
    auto picture = std::make_shared<Picture>();
    picture->name = name;
    picture->space = space;
    picture->hash = Hasher().text(bytes).value(space).result();
    picture->bytes = std::move(bytes);
    std::unique_lock lock(mutex);
    auto found = known.find(picture->hash);
    if (found == known.end()) {
        lock.unlock();
        const PictureFacts facts = facts_of(*picture);
        lock.lock();
        found = known.emplace(picture->hash, facts).first;
    }
    picture->format = found->second.format;
    picture->width = found->second.width;
    picture->height = found->second.height;
    picture->mean = found->second.mean;
    return picture;
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
    glm::dvec4 sum(0.0);
    for (int corner = 0; corner < (closest ? 1 : 4); ++corner) {
        const int right = corner & 1;
        const int low = corner >> 1;
        const double weight =
            closest ? 1.0
                    : (right != 0 ? x - left : left + 1 - x) * (low != 0 ? y - top : top + 1 - y);
        const int64_t column =
            wrapped(static_cast<int64_t>(left) + right, width, texture_.extension);
        const int64_t row = wrapped(static_cast<int64_t>(top) + low, height, texture_.extension);
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
