// SPDX-License-Identifier: GPL-3.0-or-later
// Bake: textures drawn into a new picture, for files that cannot say what is done with a texel.
#pragma once

#include "model/texture.h"

#include <glm/vec4.hpp>

#include <array>
#include <optional>

namespace lodestone::format {

/// What goes into one channel of the new picture.
struct ChannelSource {
    const Texture* texture = nullptr;  // null: `constant`
    int component = -1;                // 0...2: of its color; -1: its number
    double constant = 1;
};

/// Red, green, blue, alpha.
using Recipe = std::array<ChannelSource, 4>;

/// The three components of a texture's color, alpha 1.
Recipe color_recipe(const Texture& texture);

/// Whether two textures show their pictures at the same places, in the same manner.
bool same_layout(const Texture& a, const Texture& b);

/// The result times `limit` is what the recipe says; it is shown by TextureChannel::Color, offset 0, scale
/// 1 (a number by the channel it was put in), and never clipped: a clipped picture gets a border.
struct BakedTexture {
    Texture texture;
    double limit = 1;
};

/// An 8 bit PNG of the largest picture's size. All textures of the recipe have the same layout.
/// What exceeds 1 is clamped, or, `bright`, divided by a power of two. Nothing when a picture is
/// not resident or broken, or there are too many pixels.
std::optional<BakedTexture> bake_recipe(const Recipe& recipe, ColorSpace space,
                                        bool bright = false);

/// Of all that bake_recipe() looks at.
Hash hash_of(const Recipe& recipe, ColorSpace space);

}  // namespace lodestone::format
