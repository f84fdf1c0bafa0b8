// SPDX-License-Identifier: GPL-3.0-or-later
// Material: what a surface looks like, in the terms of the principled model.
#pragma once

#include "model/texture.h"

#include <string>

namespace lodestone {

/// What alpha below 1 does.
enum class AlphaMode : uint8_t {
    Opaque = 0,  // nothing
    Blend = 1,   // the surface covers that share of what is behind it
    Clip = 2,    // it is there where alpha >= alpha_cutoff, and nowhere else
};

/// A number or color that has a texture is the texture's value; the field beside it holds the mean,
/// which is what everything that looks at no texture uses. Numbers are 0...1 unless said otherwise.
struct Material {
    std::string name;            // the user's; any bytes
    glm::dvec3 base_color{0.8};  // linear Rec.709
    double roughness = 0.5;      // perceptual (alpha = roughness squared)
    double metallic = 0;
    double specular = 0.5;     // 0.5 is an index of refraction of 1.45
    glm::dvec3 emission{0.0};  // linear, W/(sr m^2)

    Texture base_color_texture;
    Texture roughness_texture;
    Texture metallic_texture;
    Texture emission_texture;
    bool vertex_colors = false;  // base color (its texture's too) times Mesh::colors, alpha too

    double alpha = 1;
    Texture alpha_texture;
    AlphaMode alpha_mode = AlphaMode::Opaque;
    double alpha_cutoff = 0.5;

    double transmission = 0;  // share of light that is refracted instead of scattered
    double ior = 1.45;        // > 0; of what is refracted
    double clearcoat = 0;
    double clearcoat_roughness = 0.03;

    Texture normal_texture;  // tangent space, 0...1 for -1...1, green up
    double normal_strength = 1;
    Texture bump_texture;      // height: channel's value times bump_distance
    double bump_distance = 0;  // metres from black to white; below 0 inward

    /// Mixed with another one (which may be mixed, too; kMostMixtures at most): shading is (1 -
    /// mix) of this and mix of that.
    std::shared_ptr<const Material> other;
    double mix = 0;
    Texture mix_texture;
};

inline constexpr int kMostMixtures = 64;  // deeper ones are a mistake or an attack

/// Brings its own numbers, which are finite, into their ranges: shares 0...1, ior .1...10, normal
/// strength 0...10.
void clamp_numbers(Material& material);

/// Of everything but the names.
Hash hash_of(const Material& material);

/// Whether anything of it (or of what it is mixed with) is looked up by texture coordinates.
bool textured(const Material& material);

/// Calls visit(texture) for every texture it has, not those of the other. Material_ is Material or
/// const Material.
template <typename Material_, typename Visit>
void for_own_textures(Material_& material, const Visit& visit) {
    for (auto* texture :
         {&material.base_color_texture, &material.roughness_texture, &material.metallic_texture,
          &material.emission_texture, &material.alpha_texture, &material.normal_texture,
          &material.bump_texture, &material.mix_texture}) {
        if (*texture)
            visit(*texture);
    }
}

/// The same, those of the other included.
template <typename Visit>
void for_each_texture(const Material& material, const Visit& visit) {
    for_own_textures(material, visit);
    if (material.other)
        for_each_texture(*material.other, visit);
}

}  // namespace lodestone
