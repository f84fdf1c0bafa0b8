// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/texel_rows.h"

#include "base/color.h"
#include "image/texture_sampler.h"

#include <algorithm>
#include <cmath>

namespace lodestone::image {
namespace {

/// The linear values of all whole numbers of so many bits.
std::vector<float> decoded_srgb(unsigned bits) {
    std::vector<float> out(size_t{1} << bits);
    for (size_t i = 0; i < out.size(); ++i)
        out[i] = decode_srgb(static_cast<float>(i) / static_cast<float>(out.size() - 1));
    return out;
}

const std::vector<float>& decoded_srgb_bytes() {
    // Law: decode_srgb() of each byte.
    static const std::vector<float> kValues = decoded_srgb(8);
    return kValues;
}

const std::vector<float>& decoded_srgb_words() {
    // Law: decode_srgb() of each number of 16 bits.
    static const std::vector<float> kValues = decoded_srgb(16);
    return kValues;
}

/// The byte of a texel that holds a channel. Missing alpha is read from the first one: a table for
/// it holds one value.
size_t place_of(int channel, int channels) {
    const bool gray = channels < 3;
    if (channel == 3)
        return channels == 2 ? 1 : channels == 4 ? 3 : 0;
    return gray ? 0 : static_cast<size_t>(channel);
}

void clear_infinite(float* values, size_t count) {
    for (size_t i = 0; i < count; ++i) {
        if (!std::isfinite(values[i]))
            values[i] = 0;
    }
}

/// Divides the colors of a file of floats by their alpha.
void make_straight(float* rgba, size_t count) {
    for (size_t i = 0; i < 4 * count; i += 4) {
        const float alpha = rgba[i + 3];
        if (alpha > 0 && alpha != 1) {
            for (size_t c = 0; c < 3; ++c)
                rgba[i + c] /= alpha;
        }
    }
    clear_infinite(rgba, 4 * count);
}

void read_words(const PackedImage& image, int y, bool srgb, float* rgba) {
    const unsigned char* from = image.row(y);
    const auto word = [](const unsigned char* at) {
        return static_cast<size_t>(at[0]) << 8u | at[1];
    };
    const auto plain = [](size_t number) { return static_cast<float>(number) / 65535.0f; };
    const float* linear = srgb ? decoded_srgb_words().data() : nullptr;
    for (int x = 0; x < image.width; ++x, rgba += 4, from += 2 * ptrdiff_t{image.channels}) {
        for (int c = 0; c < 3; ++c) {
            const size_t value = word(from + 2 * place_of(c, image.channels));
            rgba[c] = linear != nullptr ? linear[value] : plain(value);
        }
        const bool opaque = image.channels % 2 == 1;
        rgba[3] = opaque ? 1.0f : plain(word(from + 2 * place_of(3, image.channels)));
    }
}

std::array<int, 4> sources_of(const Texture& texture) {
    switch (texture.channel) {
        case TextureChannel::Red:
            return {0, 0, 0, 3};
        case TextureChannel::Green:
            return {1, 1, 1, 3};
        case TextureChannel::Blue:
            return {2, 2, 2, 3};
        case TextureChannel::Alpha:
            return {3, 3, 3, 3};
        case TextureChannel::Color:
        case TextureChannel::Luma:
            break;
    }
    return {TexelMap::kColor, TexelMap::kColor, TexelMap::kColor, 3};
}

}  // namespace

TexelMap color_map(const Texture& texture, const std::function<float(double)>& value) {
    TexelMap map;
    map.apply = [texture, value](float* rgba, size_t count) {
        for (; count > 0; --count, rgba += 4) {
            const glm::dvec3 color = color_of(texture, {rgba[0], rgba[1], rgba[2], rgba[3]});
            for (int c = 0; c < 3; ++c)
                rgba[c] = value(color[c]);
        }
    };
    if (texture.channel != TextureChannel::Color)
        map.sources = sources_of(texture);
    return map;
}

TexelMap number_map(const Texture& texture, const std::function<float(double)>& value) {
    TexelMap map;
    map.apply = [texture, value](float* rgba, size_t count) {
        for (; count > 0; --count, rgba += 4) {
            const float made = value(number_of(texture, {rgba[0], rgba[1], rgba[2], rgba[3]}));
            std::fill_n(rgba, 3, made);
            rgba[3] = 1;
        }
    };
    map.sources = sources_of(texture);
    return map;
}

TexelRows::TexelRows(const PackedImage& image, ColorSpace space, TexelMap map)
    : image_(image), space_(space), map_(std::move(map)) {
    const bool gray = image.channels < 3;
    const bool by_channel = gray || std::find(map_.sources.begin(), map_.sources.end(),
                                              TexelMap::kColor) == map_.sources.end();
    if (image.depth != 8)
        return;
    const float* linear = space == ColorSpace::Srgb ? decoded_srgb_bytes().data() : nullptr;
    std::vector<float> texels(size_t{4} * 256);
    for (size_t i = 0; i < 256; ++i) {
        const float plain = static_cast<float>(i) / 255.0f;
        std::fill_n(texels.data() + 4 * i, 3, linear != nullptr ? linear[i] : plain);
        texels[4 * i + 3] = image.channels % 2 == 1 ? 1.0f : plain;
    }
    if (by_channel && map_.apply) {
        map_.apply(texels.data(), 256);
        map_.apply = nullptr;
    }
    values_.resize(texels.size());
    for (size_t c = 0; c < 4; ++c) {
        const int source = by_channel ? map_.sources[c] : static_cast<int>(c);
        places_[c] = place_of(source, image.channels);
        for (size_t i = 0; i < 256; ++i)
            values_[256 * c + i] = texels[4 * i + c];
    }
}

void TexelRows::look_up(const unsigned char* from, float* rgba) const {
    const float* red = values_.data();
    const float* green = red + 256;
    const float* blue = green + 256;
    const float* alpha = blue + 256;
    const auto [r, g, b, a] = places_;
    const int channels = image_.channels;
    for (int x = 0; x < image_.width; ++x, from += channels, rgba += 4) {
        const float texel[4] = {red[from[r]], green[from[g]], blue[from[b]], alpha[from[a]]};
        std::copy_n(texel, 4, rgba);
    }
}

void TexelRows::read(int y, float* rgba) const {
    const auto width = static_cast<size_t>(image_.width);
    if (image_.is_floats()) {
        std::copy_n(image_.floats.data() + 4 * width * static_cast<size_t>(y), 4 * width, rgba);
        make_straight(rgba, width);
    } else if (image_.depth == 16) {
        read_words(image_, y, space_ == ColorSpace::Srgb, rgba);
    } else {
        look_up(image_.row(y), rgba);
    }
    if (map_.apply)
        map_.apply(rgba, width);
}

Image all_texels(const TexelRows& rows) {
    Image image;
    image.width = rows.width();
    image.height = rows.height();
    image.linear = true;
    image.pixels.reserve(4 * image.size());
    std::vector<float> row(4 * static_cast<size_t>(rows.width()));
    for (int y = 0; y < rows.height(); ++y) {
        rows.read(y, row.data());  // within the cache: the image is not filled with zeros first
        image.pixels.insert(image.pixels.end(), row.begin(), row.end());
    }
    return image;
}

Image unpacked(PackedImage&& image) {
    Image out;
    if (image.is_floats()) {
        out.width = image.width;
        out.height = image.height;
        out.pixels = std::move(image.floats);
    } else {
        out = all_texels(TexelRows(image, ColorSpace::Linear));
    }
    out.linear = image.is_floats();
    return out;
}

Image linear_picture(const std::filesystem::path& path) {
    PackedImage packed = read_packed(path);
    if (packed.is_floats())
        return unpacked(std::move(packed));
    Image picture = all_texels(TexelRows(packed, ColorSpace::Srgb));
    for (size_t i = 0; i < picture.pixels.size(); i += 4) {
        for (size_t c = 0; c < 3; ++c)
            picture.pixels[i + c] *= picture.pixels[i + 3];
    }
    return picture;
}

PackedImage packed_colors(const TexelRows& rows) {
    PackedImage out = blank_packed(rows.width(), rows.height(), 3, 8, "a picture");
    std::vector<float> row(4 * static_cast<size_t>(rows.width()));
    for (int y = 0; y < rows.height(); ++y) {
        rows.read(y, row.data());
        unsigned char* to = out.row(y);
        for (size_t x = 0; x < row.size(); x += 4, to += 3) {
            for (size_t c = 0; c < 3; ++c)
                to[c] = byte_of(row[x + c]);
        }
    }
    return out;
}

}  // namespace lodestone::image
