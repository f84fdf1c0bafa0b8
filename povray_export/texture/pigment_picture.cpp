// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/texture/pigment_picture.h"

#include "base/color.h"
#include "image/image_reduction.h"
#include "image/mask_texels.h"
#include "image/texture_sampler.h"
#include "povray_export/texture/height_map.h"

#include <algorithm>
#include <functional>
#include <mutex>
#include <unordered_map>

namespace lodestone::povray {
namespace {

/// Whether the numbers of a picture, which are its red, are a mask's.
bool is_mask(const image::TexelRows& rows) {
    image::MaskTexels texels{rows.width(), rows.height(), {}};
    texels.alpha.reserve(rows.size());
    std::vector<float> row(4 * static_cast<size_t>(rows.width()));
    for (int y = 0; y < rows.height(); ++y) {
        rows.read(y, row.data());
        for (size_t i = 0; i < row.size(); i += 4)
            texels.alpha.push_back(image::byte_of(row[i]));
    }
    image::SeenTexels seen = image::unseen_texels(rows.width(), rows.height());
    std::fill(seen.blocks.begin(), seen.blocks.end(), uint8_t{1});
    return image::count(texels, seen).is_mask();
}

/// Makes the numbers of a mask that was made smaller 0 or 1, but for its edges, of the same mean:
/// else all of a tree far away is half clear, and rays go on through each of its leaves.
void sharpen(image::Image& picture) {
    // The factor on differences to the level that becomes 1/2.
    // Taste: edges of half a texel; a larger value draws steps.
    constexpr float kSlope = 4;
    const auto sharp = [](float value, float level) {
        return std::clamp(0.5f + kSlope * (value - level), 0.0f, 1.0f);
    };
    double sum = 0;
    for (size_t i = 0; i < picture.pixels.size(); i += 4)
        sum += static_cast<double>(picture.pixels[i]);
    float low = -0.5f;
    float high = 1.5f;
    // Law: 2^-12 of the range is finer than a step of 8 bits.
    for (int step = 0; step < 12; ++step) {
        const float level = (low + high) / 2;
        double found = 0;
        for (size_t i = 0; i < picture.pixels.size(); i += 4)
            found += static_cast<double>(sharp(picture.pixels[i], level));
        (found > sum ? low : high) = level;
    }
    for (size_t i = 0; i < picture.pixels.size(); ++i) {
        if (i % 4 != 3)
            picture.pixels[i] = sharp(picture.pixels[i], (low + high) / 2);
    }
}

}  // namespace

bool is_number(PigmentContent content) {
    return content == PigmentContent::Number || content == PigmentContent::Alpha ||
           content == PigmentContent::Height;
}

int halved(int side, int halvings) {
    return std::max(1, side >> halvings);
}

std::string pigment_picture(const Texture& texture, PigmentContent content, int halvings) {
    if (content == PigmentContent::Height)
        return png_of(*height_map(texture));
    const bool number = is_number(content);
    const image::PackedPtr from = image::packed(*texture.picture);
    const auto rows_of = [&](const std::function<float(double)>& value) {
        return image::TexelRows(
            *from, texture.picture->space,
            number ? image::number_map(texture, value) : image::color_map(texture, value));
    };
    const auto clamped = [](double value) {
        return static_cast<float>(std::clamp(value, 0.0, 1.0));
    };
    if (halvings == 0 && content != PigmentContent::Leaf) {
        const auto shown = [&](double value) {
            return number ? clamped(value) : encode_srgb(clamped(value));
        };
        return image::png_bytes(image::packed_colors(rows_of(shown)), image::PngEffort::Quick);
    }
    const image::TexelRows rows = rows_of(clamped);
    const bool mask = content == PigmentContent::Alpha && is_mask(rows);
    image::Image to = halvings > 0 ? image::reduced(rows, halved(rows.width(), halvings),
                                                    halved(rows.height(), halvings))
                                   : image::all_texels(rows);
    if (content == PigmentContent::Leaf)
        image::spread_into_clear(to);
    for (size_t i = 3; i < to.pixels.size(); i += 4)
        to.pixels[i] = 1;  // POV-Ray would make holes
    if (mask)
        sharpen(to);
    to.linear = !number;  // numbers are not encoded
    return image::png_bytes(to, image::PngEffort::Quick);
}

double brightest_of(const Picture& picture) {
    static std::mutex mutex;
    static std::unordered_map<Hash, double> known;
    if (picture.format != PictureFormat::Exr)
        return 1;
    {
        const std::lock_guard lock(mutex);
        const auto found = known.find(picture.hash);
        if (found != known.end())
            return found->second;
    }
    const image::PackedPtr image = image::packed(picture);
    const image::TexelRows rows(*image, picture.space);
    std::vector<float> row(4 * static_cast<size_t>(image->width));
    double most = 1;
    for (int y = 0; y < image->height; ++y) {
        rows.read(y, row.data());
        for (size_t i = 0; i < row.size(); ++i) {
            if (i % 4 != 3)
                most = std::max(most, static_cast<double>(row[i]));
        }
    }
    const std::lock_guard lock(mutex);
    return known[picture.hash] = most;
}

}  // namespace lodestone::povray
