// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/sent_radiance.h"

#include "base/maths.h"
#include "light/light_arrival.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>

namespace lodestone::light {
namespace {

/// The share of a highlight of metals' kind that a lamp keeps by the cosine of its angle: POV-Ray's
/// approximation of Fresnel's term.
double fresnel_share(double cosine) {
    // Law: POV-Ray 3.7's.
    constexpr double kScale = 0.014567225;
    // Law: POV-Ray 3.7's.
    constexpr double kPole = 1.12;
    // Law: POV-Ray 3.7's.
    constexpr double kLeast = 0.011612903;
    const double angle = std::acos(std::clamp(cosine, -1.0, 1.0)) / (kPi / 2);
    const double away = angle - kPole;
    return std::clamp(kScale / (away * away) - kLeast, 0.0, 1.0);
}

/// The part of the radiance that is highlight; of a lamp that the point faces. POV-Ray multiplies it
/// by no cosine of the lamp's angle. `head_on`: the light that arrives from the lamp.
glm::dvec3 highlight_radiance(const Light& light, const LitPoint& point,
                              const glm::dvec3& head_on) {
    const SurfaceHighlight& shine = point.highlight;
    const glm::dvec3 way = light.position - point.position;
    const double distance = glm::length(way);
    if (!(shine.albedo > 0) || !(distance > 0))
        return glm::dvec3(0.0);
    const glm::dvec3 to_light = way / distance;
    const glm::dvec3 half = to_light + point.to_eye;
    const double length = glm::length(half);
    const double cosine = length > 0 ? glm::dot(half, point.normal) / length : 0;
    if (!(cosine > 0))
        return glm::dvec3(0.0);
    const double n = shine.exponent;
    const double peak = (n + 2) / (4 * (2 - std::exp2(-n / 2)));  // Law: POV-Ray's specular albedo
    const double kept = 1 - shine.fading * (1 - fresnel_share(glm::dot(to_light, point.normal)));
    // Single precision is a third of the time, and nobody sees a thousandth of a highlight.
    const auto falloff =
        static_cast<double>(std::pow(static_cast<float>(cosine), static_cast<float>(n)));
    return shine.albedo * peak * kept * falloff * head_on;
}

}  // namespace

glm::dvec3 sent_radiance(const Light& light, const LitPoint& point) {
    const LightArrival arrives = light_arrival(light, point.position, point.normal);
    if (!(arrives.surface.x + arrives.surface.y + arrives.surface.z > 0))
        return glm::dvec3(0.0);
    return point.albedo * arrives.surface + highlight_radiance(light, point, arrives.head_on);
}

}  // namespace lodestone::light
