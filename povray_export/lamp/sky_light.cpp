// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/lamp/sky_light.h"

#include "base/maths.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace lodestone::povray {

double stepped_factor(double factor) {
    // The steps of a factor.
    // Taste: fine enough to keep means, coarse enough that rounding does not make other files.
    constexpr double kFactorSteps = 256;
    return std::round(limited(factor, 0, 1) * kFactorSteps) / kFactorSteps;
}

SkyLightPtr even_sky_light(double factor) {
    auto light = std::make_shared<SkyLight>();
    light->factor = stepped_factor(factor);
    light->hash = Hasher().value(light->factor).result();
    return light;
}

double share_of_grade(uint8_t grade) {
    const double root = static_cast<double>(grade) / (kSkyGrades - 1);
    return root * root;
}

uint8_t grade_of_share(double share) {
    return static_cast<uint8_t>(std::lround((kSkyGrades - 1) * std::sqrt(limited(share, 0, 1))));
}

uint8_t SkyLight::grade(size_t triangle, int corner, const glm::vec3& at) const {
    if (!shares)
        return grade_of_share(factor);
    const uint8_t byte = shares->corners.at(3 * triangle + static_cast<size_t>(corner));
    const double here = limited(factor + glm::dot(slope, glm::dvec3(at) - middle), 0, 1);
    return grade_of_share(here * light::share_of_byte(byte));
}

}  // namespace lodestone::povray
