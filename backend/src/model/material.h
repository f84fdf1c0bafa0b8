// SPDX-License-Identifier: GPL-3.0-or-later
// Material: what a surface looks like, in the terms of the principled model.
#pragma once

#include "base/hash.h"

#include <glm/vec3.hpp>

#include <string>

namespace lodestone {

struct Material {
    std::string name;            // the user's; any bytes
    glm::dvec3 base_color{0.8};  // linear Rec.709
    double roughness = 0.5;      // 0...1, perceptual (alpha = roughness squared)
    double metallic = 0;         // 0...1
    double specular = 0.5;       // 0...1; 0.5 is an index of refraction of 1.45
    glm::dvec3 emission{0.0};    // linear, W/(sr m^2)
};

/// Of everything but the name.
Hash hash_of(const Material& material);

}  // namespace lodestone
