// SPDX-License-Identifier: GPL-3.0-or-later
// Light writer: Blender's lights as light_source statements with the energy Cycles gives them.
#pragma once

#include "base/error.h"
#include "light/lamp_grids.h"

#include <limits>
#include <optional>
#include <string>

namespace lodestone::povray {

/// The rays by which a light's size is sampled.
struct LightSampling {
    int rays = 17;          // along the edge of a large lamp, 2^n + 1; smaller lamps in proportion
    bool thorough = false;  // true: more rays are cast before POV-Ray decides whether it needs all
    /// The steps that can be told apart in the widest penumbra: more rays are not needed.
    double steps = std::numeric_limits<double>::infinity();
    /// The grid of a lamp, where it is known what the lamp lights; `steps` does not count then.
    std::optional<light::LampGrid> grid{};
};

/// Appends one light_source, or nothing for a light without power. A surface of albedo a (its
/// pigment; lights carry a 1 / pi) sends back, S and P being the power:
///   sun    a S / pi on a facing surface; seen as a disk, S times the mean cosine of it
///   point  a P / (4 pi^2 (d^2 + r^2)): a sphere of radius r that turns a disk to whom it lights
///   spot   the same times cos angle smoothstep((cos angle - cos outer) / (blend (1 - cos outer)))
///   area   a radiance P / (4 A) of each part of it, with the cosine at both ends
/// Lights have grids of rays for their sizes, refined where these disagree, without noise; one ray
/// is a point. A light for which POV-Ray has no way is drawn as near to it as can be and becomes a
/// problem. `bound` is around all objects; suns start outside of it, for objects behind a parallel
/// light cast no shadow.
void append_light(std::string& out, const Light& light, const Bound& bound,
                  const LightSampling& sampling, Problems& problems);

}  // namespace lodestone::povray
