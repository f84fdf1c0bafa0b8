// SPDX-License-Identifier: GPL-3.0-or-later
// Texture: a picture laid on a surface by its texture coordinates.
#pragma once

#include "model/picture.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>

namespace lodestone {

/// Which of a texel's numbers counts where one number is wanted.
enum class TextureChannel : uint8_t {
    Color = 0,
    Red = 1,
    Green = 2,
    Blue = 3,
    Alpha = 4,
    Luma = 5
};

/// The texels outside of the picture, where its coordinates are not within 0...1.
enum class TextureExtension : uint8_t {
    Repeat = 0,
    Extend = 1,  // the border's texels
    Clip = 2,    // black, alpha 0
    Mirror = 3,
};

enum class TextureInterpolation : uint8_t { Linear = 0, Closest = 1 };

/// The value at mesh coordinates (u, v) is offset + scale * texel(to_picture (u, v, 1)), by channel
/// of color; a single number takes the x of offset and scale, and `channel` of the texel (Color:
/// its luma). v = 0 is the picture's lowest row.
struct Texture {
    PicturePtr picture;  // null: no texture
    TextureChannel channel = TextureChannel::Color;
    TextureExtension extension = TextureExtension::Repeat;
    TextureInterpolation interpolation = TextureInterpolation::Linear;
    std::array<double, 6> to_picture{1, 0, 0, 0, 1, 0};  // row-major 2x3
    glm::dvec3 scale{1.0};
    glm::dvec3 offset{0.0};

    explicit operator bool() const { return picture != nullptr; }
};

/// Converts mesh coordinates to picture coordinates.
glm::dvec2 to_picture(const Texture& texture, glm::dvec2 uv);

Hash hash_of(const Texture& texture);

}  // namespace lodestone
