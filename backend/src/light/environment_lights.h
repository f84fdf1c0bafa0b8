// SPDX-License-Identifier: GPL-3.0-or-later
// Environment lights: few suns and one uniform sky that light surfaces as an environment picture
// does.
#pragma once

#include "model/view.h"

#include <vector>

namespace lodestone::light {

struct EnvironmentLight {
    glm::dvec3 direction{0, 0, -1};  // the direction in which the light travels, of length 1
    glm::dvec3 irradiance{0.0};      // on a surface that faces the light
};

struct EnvironmentLights {
    glm::dvec3 ambient{0.0};               // the radiance of the uniform sky
    std::vector<EnvironmentLight> lights;  // at most as many as asked for
};

/// Replaces a world's environment. Its darkest radiance, taken everywhere, is the uniform sky. The
/// rest is divided into regions of equal brightness, each a sun from the middle of its light, and
/// the strengths of the suns are then fitted so that surfaces facing any way receive what the
/// picture gives them. Throws Error(BadFile) for a picture that cannot be decoded. cost: that of
/// decoding. source: Debevec, A median cut algorithm for light probe sampling (the regions)
EnvironmentLights environment_lights(const World& world, size_t count);

/// The direction of a texel at (u, v) in 0...1, in the picture's own frame: u = 1/2 is +X, falling
/// u turns to +Y; v = 1 is +Z. This is Blender's equirectangular mapping.
glm::dvec3 equirectangular_direction(double u, double v);

}  // namespace lodestone::light
