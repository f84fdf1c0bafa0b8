// SPDX-License-Identifier: GPL-3.0-or-later
#include "solids/stand_in_material.h"

#include "model/finish.h"
#include "solids/solid_replacement.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace lodestone::solids {
namespace {

/// Sampling noise may leave a mean outside its range by a rounding; a value that is not a number
/// becomes `usual`.
double within(double value, double most, double usual) {
    return std::isfinite(value) ? std::clamp(value, 0.0, most) : usual;
}

}  // namespace

Material mean_material(const Attributes& attributes) {
    const Material usual;
    Material out;
    out.name = "stand-in";
    for (int i = 0; i < 3; ++i) {
        out.base_color[i] = within(attributes.color[i], 1, usual.base_color[i]);
        out.emission[i] = within(attributes.emission[i], 1e30, 0);
    }
    set_finish(out, SolidFinish{attributes.roughness, attributes.metallic, attributes.specular});
    return out;
}

Material clear_material(Material material, double opacity) {
    if (opacity < 1) {
        material.alpha_mode = AlphaMode::Blend;
        material.alpha = surface_alpha(opacity);
    }
    return material;
}

void brighten(Material& material, const glm::dvec3& factor) {
    material.base_color =
        glm::clamp(material.base_color * factor, glm::dvec3(0.0), glm::dvec3(1.0));
    if (material.base_color_texture) {
        // One factor for all pictures of the same hues, so that POV-Ray needs one picture for them.
        const double mean = (factor.x + factor.y + factor.z) / 3;
        material.base_color_texture.scale *= mean;
        material.base_color_texture.offset *= mean;
    }
    if (material.other) {
        auto other = std::make_shared<Material>(*material.other);
        brighten(*other, factor);
        material.other = std::move(other);
    }
}

}  // namespace lodestone::solids
