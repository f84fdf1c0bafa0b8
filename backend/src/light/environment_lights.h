// SPDX-License-Identifier: GPL-3.0-or-later
// Environment lights: few suns and one uniform sky that light surfaces as a picture all around
// does.
#pragma once

#include "model/view.h"

#include <vector>

namespace lodestone::light {

struct EnvironmentLight {
    glm::dvec3 direction{0, 0, -1};  // the way the light travels, of length 1
    glm::dvec3 irradiance{0.0};      // on a facing surface
};

struct EnvironmentLights {
    glm::dvec3 ambient{0.0};               // radiance of the uniform sky
    std::vector<EnvironmentLight> lights;  // at most as many as asked for
};

/// Replaces a world's environment. The darkest part of it everywhere is the uniform sky; the rest
/// is cut into regions of equal brightness, each a sun from the middle of its light, and the suns'
/// strengths are then fitted so that surfaces facing any way receive what the picture gives them.
/// Throws Error(BadFile) for a picture that cannot be decoded. cost: that of decoding.
/// source: Debevec, A median cut algorithm for light probe sampling (the regions)
EnvironmentLights environment_lights(const World& world, size_t count);

/// The direction a texel at (u, v) in 0...1 is seen in, in the picture's own frame: u = 1/2 is +X,
/// falling u turns to +Y; v = 1 is +Z. Blender's equirectangular mapping.
glm::dvec3 equirectangular_direction(double u, double v);

}  // namespace lodestone::light
