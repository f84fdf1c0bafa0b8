// SPDX-License-Identifier: GPL-3.0-or-later
// Environment lights: few suns and one uniform sky that light surfaces as an environment picture
// does.
#pragma once

#include "light/environment/uneven_sky.h"
#include "model/view.h"

#include <memory>
#include <vector>

namespace lodestone::light {

struct EnvironmentLight {
    glm::dvec3 direction{0, 0, -1};  // the direction in which the light travels, of length 1
    glm::dvec3 irradiance{0.0};      // on a surface that faces the light
    double angle = 0;                // radians across, of one peak that is wider than a texel
};

struct EnvironmentLights {
    glm::dvec3 ambient{0.0};               // the radiance of the uniform sky
    std::vector<EnvironmentLight> lights;  // at most as many as asked for
    /// The sky by direction, in parts of the uniform one. Null: it is the same everywhere.
    std::shared_ptr<const UnevenSky> uneven{};
};

/// Replaces a world's environment. Its darkest radiance, taken everywhere, is the uniform sky. The
/// rest is divided into regions of equal brightness, each a sun from the middle of its light, and
/// the strengths of the suns are then fitted so that surfaces facing any way receive what the
/// picture gives them. Throws Error(BadFile) for a picture that cannot be decoded. cost: that of
/// decoding. source: Debevec, A median cut algorithm for light probe sampling (the regions)
EnvironmentLights environment_lights(const World& world, size_t count);

/// The same where rays find what each place sees of the sky: only its peaks become lights, so many
/// that each stands for as much as one of `count` would for all of the sky. The rest is uneven.
EnvironmentLights environment_peaks(const World& world, size_t count);

}  // namespace lodestone::light
