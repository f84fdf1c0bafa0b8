// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/material.h"

#include <algorithm>

namespace lodestone {

void clamp_numbers(Material& material) {
    for (double* share : {&material.roughness, &material.metallic, &material.specular,
                          &material.alpha, &material.alpha_cutoff, &material.transmission,
                          &material.clearcoat, &material.clearcoat_roughness, &material.mix})
        *share = std::clamp(*share, 0.0, 1.0);
    material.ior = std::clamp(material.ior, 0.1, 10.0);
    material.normal_strength = std::clamp(material.normal_strength, 0.0, 10.0);
}

Hash hash_of(const Material& material) {
    Hasher hasher;
    for (int i = 0; i < 3; ++i)
        hasher.value(material.base_color[i]).value(material.emission[i]);
    for (const Texture* texture :
         {&material.base_color_texture, &material.roughness_texture, &material.metallic_texture,
          &material.emission_texture, &material.alpha_texture, &material.normal_texture,
          &material.bump_texture, &material.mix_texture})
        hasher.value(hash_of(*texture));
    return hasher.value(material.roughness)
        .value(material.metallic)
        .value(material.specular)
        .value(material.vertex_colors)
        .value(material.alpha)
        .value(material.alpha_mode)
        .value(material.alpha_cutoff)
        .value(material.transmission)
        .value(material.ior)
        .value(material.clearcoat)
        .value(material.clearcoat_roughness)
        .value(material.normal_strength)
        .value(material.bump_distance)
        .value(material.other ? hash_of(*material.other) : Hash{0})
        .value(material.mix)
        .result();
}

bool textured(const Material& material) {
    bool found = false;
    for_each_texture(material, [&](const Texture&) { found = true; });
    return found;
}

}  // namespace lodestone
