// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/decoded_texels.h"

#include "image/image_reduction.h"
#include "image/texture_sampler.h"

#include <glm/common.hpp>

#include <algorithm>

namespace lodestone::image {
namespace {

/// Pictures of more pixels are decoded one at a time: 256 MiB each.
/// Taste: a larger value lets more threads take such memory at once.
constexpr size_t kLargePicture = size_t{1} << 24u;

/// The texels of rows with at most `most_side` along a side.
std::shared_ptr<DecodedTexels> with_sides(const TexelRows& rows, int most_side) {
    auto out = std::make_shared<DecodedTexels>();
    const int step = (std::max(rows.width(), rows.height()) + most_side - 1) / most_side;
    out->reduced = step > 1;
    Image image = out->reduced ? reduced(rows, (rows.width() + step - 1) / step,
                                         (rows.height() + step - 1) / step)
                               : all_texels(rows);
    out->width = image.width;
    out->height = image.height;
    out->rgba = std::move(image.pixels);
    out->least = glm::dvec4(1e30);
    for (size_t i = 0; i < out->rgba.size(); i += 4)
        out->least = glm::min(out->least, glm::dvec4(out->rgba[i], out->rgba[i + 1],
                                                     out->rgba[i + 2], out->rgba[i + 3]));
    return out;
}

}  // namespace

TexelsPtr texels_of(const Picture& picture, int most_side) {
    const PackedPtr image = packed(picture);
    return with_sides(TexelRows(*image, picture.space), most_side);
}

TexelsPtr texels_of(const TexelRows& rows, int most_side) {
    return with_sides(rows, most_side);
}

TexelsPtr texels_with_cutoff(const Texture& texture, double cutoff, int most_side) {
    const PackedPtr image = packed(*texture.picture);
    // Alpha is 1: equal weights for all texels.
    const TexelMap map =
        number_map(texture, [cutoff](double number) { return number >= cutoff ? 1.0f : 0.0f; });
    const std::shared_ptr<DecodedTexels> out =
        with_sides(TexelRows(*image, texture.picture->space, map), most_side);
    for (size_t i = 0; i < out->rgba.size(); i += 4)
        out->rgba[i + 3] = out->rgba[i];
    out->least = glm::dvec4(out->least.x);
    return out;
}

template <typename Make>
TexelsPtr TexelCache::find_or_make(Hash key, const Picture& picture, const Make& make) {
    const auto make_alone = [&]() -> TexelsPtr {
        const bool large = static_cast<size_t>(std::max(0, picture.width)) *
                               static_cast<size_t>(std::max(0, picture.height)) >
                           kLargePicture;
        std::unique_lock one(one_large_, std::defer_lock);
        if (large)
            one.lock();
        return make();
    };
    return texels_.of(key, make_alone, [](const DecodedTexels& texels) {
        return texels.rgba.size() * sizeof(float);
    });
}

TexelsPtr TexelCache::of(const Texture& texture) {
    if (!texture || texture.picture->bytes.empty())
        return nullptr;
    const Picture& picture = *texture.picture;
    return find_or_make(Hasher().value(picture.hash).result(), picture,
                        [&] { return texels_of(picture, most_side_); });
}

TexelsPtr TexelCache::at_least(const Texture& texture, double cutoff) {
    if (!texture || texture.picture->bytes.empty())
        return nullptr;
    const Picture& picture = *texture.picture;
    const Hash key = Hasher()
                         .value(picture.hash)
                         .value(texture.channel)
                         .value(texture.scale.x)
                         .value(texture.offset.x)
                         .value(cutoff)
                         .result();
    return find_or_make(key, picture,
                        [&] { return texels_with_cutoff(texture, cutoff, most_side_); });
}

}  // namespace lodestone::image
