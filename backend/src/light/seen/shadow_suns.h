// SPDX-License-Identifier: GPL-3.0-or-later
// Shadow suns: the suns of a scene whose shadows show.
#pragma once

#include "base/random.h"
#include "model/view.h"

#include <span>
#include <vector>

namespace lodestone::light {

/// A sun whose shadows show.
struct ShadowSun {
    const Light* light = nullptr;
    glm::dvec3 way{0, 0, 1};  // to it; has length 1
    double radius = 0;        // of its disk at distance 1
    double strength = 0;      // W/m^2, however it is colored
};

/// The suns among lights that throw shadows, the strongest first; those that take light away, too.
/// The lights must outlive them.
std::vector<ShadowSun> shadow_suns(std::span<const Light> lights);

/// The way to a random place on a sun; has length 1.
glm::dvec3 way_to(const ShadowSun& sun, PcgRandom& random);

}  // namespace lodestone::light
