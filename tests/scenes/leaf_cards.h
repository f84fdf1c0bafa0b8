// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures and leaf cards with known answers, shared by the tests.
#pragma once

#include "base/color.h"
#include "base/random.h"
#include "image/image.h"
#include "image/texture_sampler.h"
#include "model/material.h"
#include "scenes/small_meshes.h"

#include <functional>

namespace lodestone::foliage {

/// color(x, y) of the middle of every texel, 0...1 from the lower left corner: linear color, alpha.
inline PicturePtr picture(int side, const std::function<glm::dvec4(double, double)>& color) {
    image::Image image;
    image.width = image.height = side;
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            const glm::dvec4 texel = color((column + 0.5) / side, 1 - (row + 0.5) / side);
            for (int c = 0; c < 3; ++c)
                image.pixels.push_back(lodestone::encode_srgb(static_cast<float>(texel[c])));
            image.pixels.push_back(static_cast<float>(texel.w));
        }
    }
    return image::make_picture(image::png_bytes(image), ColorSpace::Srgb, "picture");
}

inline Texture texture(PicturePtr picture, TextureChannel channel = TextureChannel::Color) {
    Texture out;
    out.picture = std::move(picture);
    out.channel = channel;
    out.interpolation = TextureInterpolation::Closest;
    return out;
}

/// Shows a picture's color and is there where its alpha says.
inline Material leaf(const PicturePtr& picture, AlphaMode mode = AlphaMode::Clip) {
    Material material;
    material.name = "leaf";
    material.base_color = glm::dvec3(picture->mean);
    material.base_color_texture = texture(picture);
    material.alpha_mode = mode;
    material.alpha = picture->mean.w;
    material.alpha_texture = texture(picture, TextureChannel::Alpha);
    return material;
}

/// Green on the left, nothing on the right.
inline PicturePtr left_half(int side = 16) {
    return picture(side, [](double x, double) {
        return x < 0.5 ? glm::dvec4(0.1, 0.6, 0.1, 1) : glm::dvec4(1, 0, 0, 0);
    });
}

/// quad() with the whole picture on it.
inline Mesh card(float width, float height) {
    Mesh mesh = shapes::quad(width, height);
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    return mesh;
}

/// A stem (slot 0, of `sides` x `sides` cells) and `leaves` cards (slot 1) around it in a ball.
inline Mesh tree(int leaves, uint32_t sides = 8) {
    Mesh mesh;
    for (uint32_t j = 0; j <= sides; ++j) {
        for (uint32_t i = 0; i <= sides; ++i) {
            const double angle = 6.283185307179586 * (i % sides) / sides;
            mesh.positions.emplace_back(0.1 * std::cos(angle), 0.1 * std::sin(angle),
                                        2.0 * j / sides);
            mesh.uvs.emplace_back(double(i) / sides, double(j) / sides);
        }
    }
    for (uint32_t j = 0; j < sides; ++j) {
        for (uint32_t i = 0; i < sides; ++i) {
            const uint32_t at = j * (sides + 1) + i;
            mesh.triangles.emplace_back(at, at + 1, at + sides + 2);
            mesh.triangles.emplace_back(at, at + sides + 2, at + sides + 1);
        }
    }
    mesh.slots.assign(mesh.triangles.size(), 0);
    PcgRandom random(5);
    const auto direction = [&] {
        const double z = 2 * random.uniform() - 1;
        const double angle = 6.283185307179586 * random.uniform();
        const double radius = std::sqrt(1 - z * z);
        return glm::dvec3(radius * std::cos(angle), radius * std::sin(angle), z);
    };
    for (int i = 0; i < leaves; ++i) {
        const glm::dvec3 x = direction();
        const glm::dvec3 z = glm::normalize(glm::cross(x, direction()));
        Affine place;
        place.linear = glm::dmat3(x, glm::cross(z, x), z);
        place.offset = glm::dvec3(0, 0, 2.5) + direction() * std::cbrt(random.uniform());
        append(mesh, card(0.2f, 0.3f), place, 1);
    }
    return mesh;
}

}  // namespace lodestone::foliage
