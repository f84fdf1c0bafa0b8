// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/baked_textures.h"

#include "base/color.h"
#include "base/error.h"
#include "image/texture_sampler.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace lodestone::format {
namespace {

/// The decoded pictures of a recipe, each once.
class RecipeImages {
public:
    explicit RecipeImages(const Recipe& recipe) {
        for (const ChannelSource& ingredient : recipe) {
            if (ingredient.texture == nullptr)
                continue;
            const Picture& picture = *ingredient.texture->picture;
            if (images_.contains(picture.hash))
                continue;
            const image::Image& image =
                images_.emplace(picture.hash, image::decoded(picture)).first->second;
            width_ = std::max(width_, image.width);
            height_ = std::max(height_, image.height);
        }
    }

    int width() const { return width_; }
    int height() const { return height_; }

    /// The value of a texel of the new picture, row 0 on top; outside of the picture the texture
    /// has nothing.
    double value(const ChannelSource& ingredient, int x, int y) const {
        if (ingredient.texture == nullptr)
            return ingredient.constant;
        glm::dvec4 texel(0.0);
        if (x >= 0 && y >= 0 && x < width_ && y < height_) {
            const image::Image& image = images_.at(ingredient.texture->picture->hash);
            const auto column = static_cast<size_t>(int64_t{x} * image.width / width_);
            const auto row = static_cast<size_t>(int64_t{y} * image.height / height_);
            const float* at =
                image.pixels.data() + 4 * (row * static_cast<size_t>(image.width) + column);
            texel = {at[0], at[1], at[2], at[3]};
        }
        const double value =
            ingredient.component < 0
                ? image::number_of(*ingredient.texture, texel)
                : image::color_of(*ingredient.texture, texel)[ingredient.component];
        return value > 0 ? value : 0;  // not a number: 0
    }

private:
    std::map<Hash, image::Image> images_;
    int width_ = 0;
    int height_ = 0;
};

const Texture& lead(const Recipe& recipe) {
    for (const ChannelSource& ingredient : recipe) {
        if (ingredient.texture != nullptr)
            return *ingredient.texture;
    }
    fail(Status::Internal, "a recipe without textures");
}

/// The number of texels around a clipped picture. Under a turn both directions must be stretched
/// alike, or the turn would become a shear.
glm::ivec2 border_of(const Texture& texture, int width, int height) {
    if (texture.extension != TextureExtension::Clip)
        return {0, 0};
    if (texture.to_picture[1] == 0 && texture.to_picture[3] == 0)
        return {1, 1};
    const int step = std::gcd(width, height);
    return {width / step, height / step};
}

bool resident(const Recipe& recipe) {
    return std::none_of(recipe.begin(), recipe.end(), [](const ChannelSource& ingredient) {
        return ingredient.texture != nullptr && ingredient.texture->picture->bytes.empty();
    });
}

}  // namespace

Recipe color_recipe(const Texture& texture) {
    return {{{&texture, 0}, {&texture, 1}, {&texture, 2}, {}}};
}

bool same_layout(const Texture& a, const Texture& b) {
    return a.to_picture == b.to_picture && a.extension == b.extension &&
           a.interpolation == b.interpolation;
}

std::optional<BakedTexture> bake_recipe(const Recipe& recipe, ColorSpace space, bool bright) {
    if (!resident(recipe))
        return std::nullopt;
    try {
        const RecipeImages sources(recipe);
        BakedTexture baked;
        baked.texture = lead(recipe);
        baked.texture.channel = TextureChannel::Color;
        baked.texture.scale = glm::dvec3(1.0);
        baked.texture.offset = glm::dvec3(0.0);
        const glm::ivec2 border = border_of(baked.texture, sources.width(), sources.height());
        image::Image image;
        image.width = sources.width() + 2 * border.x;
        image.height = sources.height() + 2 * border.y;
        if (image.size() > image::kMostPixels)
            return std::nullopt;
        image.pixels.reserve(4 * image.size());
        double largest = 0;
        for (int y = -border.y; y < image.height - border.y; ++y) {
            for (int x = -border.x; x < image.width - border.x; ++x) {
                for (const ChannelSource& ingredient : recipe) {
                    const double value = sources.value(ingredient, x, y);
                    largest = std::max(largest, &ingredient == &recipe[3] ? 0.0 : value);
                    image.pixels.push_back(static_cast<float>(std::min(value, 1e30)));
                }
            }
        }
        if (bright && largest > 1)
            baked.limit = std::exp2(std::ceil(std::log2(std::min(largest, 1e30))));
        for (size_t i = 0; i < image.pixels.size(); ++i) {
            float& value = image.pixels[i];
            if (i % 4 == 3)
                continue;
            value = std::min(value / static_cast<float>(baked.limit), 1.0f);
            if (space == ColorSpace::Srgb)
                value = encode_srgb(value);
        }
        if (border.x > 0) {
            baked.texture.extension = TextureExtension::Extend;
            const glm::dvec2 inner(sources.width(), sources.height());
            const glm::dvec2 outer(image.width, image.height);
            for (int row = 0; row < 2; ++row) {
                double* m = baked.texture.to_picture.data() + 3 * static_cast<ptrdiff_t>(row);
                for (int i = 0; i < 3; ++i)
                    m[i] *= inner[row] / outer[row];
                m[2] += border[row] / outer[row];
            }
        }
        baked.texture.picture = image::make_picture(image::packed(image), image::PngEffort::Small,
                                                    space, lead(recipe).picture->name);
        return baked;
    } catch (const Error&) {
        return std::nullopt;
    }
}

Hash hash_of(const Recipe& recipe, ColorSpace space) {
    Hasher hasher;
    hasher.value(space);
    for (const ChannelSource& ingredient : recipe)
        hasher
            .value(ingredient.texture == nullptr ? Hash{0}
                                                 : lodestone::hash_of(*ingredient.texture))
            .value(ingredient.component)
            .value(ingredient.constant);
    return hasher.result();
}

}  // namespace lodestone::format
