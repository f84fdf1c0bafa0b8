// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/lamp_materials.h"

namespace lodestone::hierarchy {

bool emits(const Material& material) {
    return material.emission != glm::dvec3(0.0) || (material.other && emits(*material.other));
}

void emit_more(Material& material, const glm::dvec3& factor) {
    material.emission *= factor;
    if (material.emission_texture) {
        const double mean = (factor.x + factor.y + factor.z) / 3;
        material.emission_texture.scale *= mean;
        material.emission_texture.offset *= mean;
    }
    if (material.other) {
        Material other = *material.other;
        emit_more(other, factor);
        material.other = std::make_shared<const Material>(std::move(other));
    }
}

Material unlit(const Material& material) {
    Material out = material;
    out.base_color = glm::dvec3(0.0);
    out.base_color_texture = Texture{};
    if (material.other)
        out.other = std::make_shared<const Material>(unlit(*material.other));
    return out;
}

}  // namespace lodestone::hierarchy
