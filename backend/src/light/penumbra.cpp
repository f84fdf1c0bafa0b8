// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/penumbra.h"

#include "base/maths.h"
#include "choose/criterion.h"
#include "light/light_arrival.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lodestone::light {
namespace {

double of_sun(const Light& sun, const View& view, std::span<const Bound> occluders) {
    // The least sine of the sun's elevation.
    // Taste: below it shadows cross the whole scene, so its size is the bound.
    constexpr double kFlattest = 0.1;
    Bound all;
    for (const Bound& bound : occluders)
        all = merged(all, bound);
    const double floor = all.box.low.z;
    const double down = -glm::normalize(sun.direction).z;
    const double across = 2 * std::tan(std::min(sun.angle / 2, 1.5));
    double widest = 0;
    for (const Bound& bound : occluders) {
        const double way = down > kFlattest ? (bound.box.high.z - floor) / down : 2 * all.radius;
        const double z = std::max(0.0, distance(bound, view.camera.position) - way);
        widest = std::max(widest, way * across / choose::pixel_size(view, z));
    }
    return widest;
}

// How many times the size of a light its penumbra is, at most.
// Taste: occluders a third of the way from the light enlarge it twice; nearer ones, more.
constexpr double kMagnified = 2;

double of_lamp(const Light& lamp, const View& view) {
    // The irradiance below which a light counts as not shining.
    // Law: about one step of an 8-bit display.
    constexpr double kDarkest = 0.004;
    const bool area = lamp.kind == LightKind::Area;
    const glm::dvec3 shining = glm::abs(lamp.color * lamp.power) / (4 * kPi * (area ? 1 : kPi));
    const double size = 2 * extent_of(lamp);
    const double reach = std::sqrt(std::max({shining.x, shining.y, shining.z}) / kDarkest);
    const double z = std::max(0.0, glm::length(lamp.position - view.camera.position) - reach);
    return kMagnified * size / choose::pixel_size(view, z);
}

}  // namespace

double widest_penumbra(const Light& light, const View& view, std::span<const Bound> occluders) {
    if (occluders.empty())
        return 0;
    switch (light.kind) {
        case LightKind::Sun:
            return light.angle > 0 ? of_sun(light, view, occluders) : 0;
        case LightKind::Point:
        case LightKind::Spot:
            return light.radius > 0 ? of_lamp(light, view) : 0;
        case LightKind::Area:
            return of_lamp(light, view);
    }
    return 0;
}

double penumbra_at(const Light& lamp, const View& view, const glm::dvec3& point) {
    const double z = glm::length(point - view.camera.position);
    return kMagnified * 2 * extent_of(lamp) / choose::pixel_size(view, z);
}

}  // namespace lodestone::light
