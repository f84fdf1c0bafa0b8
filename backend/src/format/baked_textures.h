// SPDX-License-Identifier: GPL-3.0-or-later
// Baked textures: textures drawn into a new picture, for files that cannot say what is done with a
// texel.
#pragma once

#include "model/texture.h"

#include <glm/vec4.hpp>

#include <array>
#include <optional>

namespace lodestone::format {

/// The source of one channel of the new picture: a texture, or a constant without one.
struct ChannelSource {
    const Texture* texture = nullptr;  // null: `constant`
    int component = -1;                // 0...2: a component of its color; -1: its one number
    double constant = 1;
};

/// The sources of red, green, blue and alpha.
using Recipe = std::array<ChannelSource, 4>;

/// The three components of a texture's color, alpha 1.
Recipe color_recipe(const Texture& texture);

/// Whether two textures show their pictures at the same places, in the same manner.
bool same_layout(const Texture& a, const Texture& b);

/// A texture whose values times `limit` are those of the recipe. It is shown by
/// TextureChannel::Color (a number by the channel it was put in) with offset 0 and scale 1. It is
/// never clipped: a clipped picture gets a border.
struct BakedTexture {
    Texture texture;
    double limit = 1;
};

/// Draws an 8 bit PNG of the largest picture's size. All textures of the recipe must have the same
/// layout. Values above 1 are clamped, or, if `bright`, all are divided by a power of two. Returns
/// nothing when a picture is not resident or broken, or there are too many pixels.
std::optional<BakedTexture> bake_recipe(const Recipe& recipe, ColorSpace space,
                                        bool bright = false);

/// The hash of all that bake_recipe() reads.
Hash hash_of(const Recipe& recipe, ColorSpace space);

}  // namespace lodestone::format
