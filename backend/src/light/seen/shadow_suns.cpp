// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/seen/shadow_suns.h"

#include "base/color.h"
#include "base/maths.h"
#include "choose/off_screen.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace lodestone::light {

std::vector<ShadowSun> shadow_suns(std::span<const Light> lights) {
    std::vector<ShadowSun> suns;
    for (const Light& light : lights) {
        const glm::dvec3 way = -glm::normalize(light.direction);
        if (light.kind != LightKind::Sun || !choose::casts_shadows(light) || !finite(way))
            continue;
        const double strength = std::abs(light.power * luminance(light.color));
        suns.push_back({&light, way, std::tan(std::clamp(light.angle / 2, 0.0, 1.5)),
                        std::isfinite(strength) ? strength : 0});
    }
    std::stable_sort(suns.begin(), suns.end(), [](const ShadowSun& a, const ShadowSun& b) {
        return a.strength > b.strength;
    });
    return suns;
}

glm::dvec3 way_to(const ShadowSun& sun, PcgRandom& random) {
    const double turn = 2 * kPi * random.uniform();
    const double out = sun.radius * std::sqrt(random.uniform());
    const glm::dvec3 u = perpendicular(sun.way);
    const glm::dvec3 v = glm::cross(sun.way, u);
    return glm::normalize(sun.way + out * (std::cos(turn) * u + std::sin(turn) * v));
}

}  // namespace lodestone::light
