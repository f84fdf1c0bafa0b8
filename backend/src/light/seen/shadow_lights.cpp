// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/seen/shadow_lights.h"

#include "base/color.h"
#include "base/maths.h"
#include "choose/off_screen.h"
#include "light/light_arrival.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace lodestone::light {
namespace {

/// The factor on the light of all but the strongest: from this part on one of them is always picked.
/// Taste: a larger value finds fainter shadows, for more rays.
constexpr double kOthers = 16;

glm::dvec3 in_disk(PcgRandom& random, const glm::dvec3& axis, double radius) {
    const double turn = 2 * kPi * random.uniform();
    const double out = radius * std::sqrt(random.uniform());
    const glm::dvec3 u = perpendicular(axis);
    const glm::dvec3 v = glm::cross(axis, u);
    return out * (std::cos(turn) * u + std::sin(turn) * v);
}

/// A random place on a lamp's surface.
glm::dvec3 place_on(const ShadowLight& lamp, const glm::dvec3& from, PcgRandom& random) {
    const Light& light = *lamp.light;
    if (light.kind != LightKind::Area) {
        const glm::dvec3 axis = glm::normalize(from - light.position);
        return finite(axis) ? light.position + in_disk(random, axis, lamp.radius) : light.position;
    }
    double u = random.uniform() - 0.5;
    double v = random.uniform() - 0.5;
    if (light.round) {  // as a disk: one number is its turn, the other its area
        const double turn = 2 * kPi * u;
        const double out = 0.5 * std::sqrt(v + 0.5);
        u = out * std::cos(turn);
        v = out * std::sin(turn);
    }
    return light.position + u * light.edge_u + v * light.edge_v;
}

}  // namespace

std::vector<ShadowLight> shadow_lights(std::span<const Light> lights) {
    std::vector<ShadowLight> out;
    for (const Light& light : lights) {
        if (!choose::casts_shadows(light))
            continue;
        ShadowLight one;
        one.light = &light;
        one.sun = light.kind == LightKind::Sun;
        const double power = std::abs(light.power * luminance(light.color));
        if (one.sun) {
            one.way = -glm::normalize(light.direction);
            one.radius = std::tan(std::clamp(light.angle / 2, 0.0, 1.5));
            one.strength = power;
        } else {
            one.radius = extent_of(light);
            one.strength = power / (4 * kPi);
        }
        if (!one.sun && light.kind != LightKind::Point) {
            one.way = glm::normalize(light.direction);
            // Law: an area shines to half of all sides.
            const double cone = light.kind == LightKind::Spot ? light.spot_size : kPi;
            one.cone_cosine = std::cos(std::clamp(cone / 2, 0.0, kPi / 2));
        }
        if (!std::isfinite(one.strength))
            one.strength = 0;
        const bool placed =
            one.sun ? finite(one.way) : finite(light.position) && std::isfinite(one.radius);
        if (placed)
            out.push_back(one);
    }
    return out;
}

double arriving(const ShadowLight& light, const glm::dvec3& point, const glm::dvec3& normal) {
    const bool sided = normal != glm::dvec3(0.0);
    if (light.sun)
        return light.strength *
               (sided ? std::clamp(glm::dot(light.way, normal), std::min(light.radius, 1.0), 1.0)
                      : 1);
    const glm::dvec3 way = light.light->position - point;
    const double own_square = glm::dot(way, way);
    const double square = std::max(own_square + light.radius * light.radius, 1e-9);
    double share = 1;
    if (sided) {
        const double facing = glm::dot(way, normal) + light.radius;
        if (!(facing > 0))
            return 0;
        share = std::min(facing / std::sqrt(square), 1.0);
    }
    if (light.light->kind != LightKind::Point && own_square > 0 &&
        !(-glm::dot(way, light.way) > light.cone_cosine * std::sqrt(own_square)))
        return 0;
    return share * light.strength / square;
}

std::span<const uint32_t> LightPicker::pick(const glm::dvec3& point, const glm::dvec3& normal,
                                            std::span<const uint32_t> among, PcgRandom& random) {
    const size_t count = among.empty() ? lights_.size() : among.size();
    const auto number = [&](size_t i) {
        return among.empty() ? static_cast<uint32_t>(i) : among[i];
    };
    arriving_.resize(count);
    double sum = 0;
    size_t most = 0;
    for (size_t i = 0; i < count; ++i) {
        arriving_[i] = arriving(lights_[number(i)], point, normal);
        sum += arriving_[i];
        if (arriving_[i] > arriving_[most])
            most = i;
    }
    const double chance = random.uniform();
    const double asked = random.uniform();
    if (count == 0 || !(arriving_[most] > 0))
        return {};
    picked_[0] = number(most);
    size_t picked = 1;
    const double others = sum - arriving_[most];
    if (!(asked * arriving_[most] < kOthers * others))
        return {picked_, 1};
    double left = chance * others;
    for (size_t i = 0; i < count; ++i) {
        if (i == most || !(arriving_[i] > 0))
            continue;
        left -= arriving_[i];
        picked_[1] = number(i);
        picked = 2;
        if (left < 0)
            break;
    }
    return {picked_, picked};
}

WayToLight way_to(const ShadowLight& light, const glm::dvec3& point, PcgRandom& random) {
    if (light.sun)
        return {glm::normalize(light.way + in_disk(random, light.way, light.radius)), kInfinity};
    const glm::dvec3 way = place_on(light, point, random) - point;
    const double length = glm::length(way);
    return length > 0 ? WayToLight{way / length, length} : WayToLight{};
}

}  // namespace lodestone::light
