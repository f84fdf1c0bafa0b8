// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/clear_materials.h"

#include "base/maths.h"

#include <memory>

namespace lodestone::light {
namespace {

/// The share of light that goes through a material's body, where it is there at all.
double transmitted(const Material& material) {
    return limited(material.transmission, 0, 1) * (1 - limited(material.metallic, 0, 1));
}

}  // namespace

bool lets_light_through(const Material& material) {
    const bool covered =
        material.alpha_mode == AlphaMode::Opaque ||
        (!material.alpha_texture && material.alpha >= 1 && !material.vertex_colors);
    return !covered || transmitted(material) > 0 ||
           (material.other && lets_light_through(*material.other));
}

Material clear_material(const Material& material) {
    Material out;
    if (!lets_light_through(material))
        return out;
    out.alpha_mode = material.alpha_mode;
    out.alpha = material.alpha;
    out.alpha_texture = material.alpha_texture;
    out.alpha_cutoff = material.alpha_cutoff;
    out.vertex_colors = material.vertex_colors;
    const double through = transmitted(material);
    if (through > 0) {
        if (material.alpha_mode == AlphaMode::Opaque) {
            out.alpha = 1;
            out.alpha_texture = {};
        }
        if (material.alpha_mode != AlphaMode::Clip) {
            out.alpha_mode = AlphaMode::Blend;
            out.alpha = limited(out.alpha, 0, 1) * (1 - through);
            out.alpha_texture.scale *= 1 - through;
            out.alpha_texture.offset *= 1 - through;
        } else if (through >= 0.5) {  // a mask of glass is a mask or nothing
            out.alpha = 0;
            out.alpha_texture = {};
        }
    }
    if (material.other) {
        out.mix = material.mix;
        out.mix_texture = material.mix_texture;
        out.other = std::make_shared<const Material>(clear_material(*material.other));
    }
    return out;
}

}  // namespace lodestone::light
