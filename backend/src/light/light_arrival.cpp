// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/light_arrival.h"

#include "base/color.h"
#include "base/maths.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lodestone::light {
namespace {

/// The share within a spot's cone: 1 inside, falling smoothly to 0 at its edge.
double in_cone(const Light& spot, double cosine) {
    const double outer = std::cos(std::min(spot.spot_size / 2, kPi / 2));
    if (!(cosine > outer))
        return 0;
    const double width = std::clamp(spot.spot_blend, 0.0, 1.0) * (1 - outer);
    const double t = width > 0 ? std::min(1.0, (cosine - outer) / width) : 1.0;
    return t * t * (3 - 2 * t);
}

/// The share of the light that an area without spread would send.
double in_spread(const Light& area, double cosine) {
    const double s = area.spread / 2;
    if (!(s > 0) || s > kPi / 2 - 0.01)
        return 1;
    const double x = std::acos(std::clamp(cosine, -1.0, 1.0));
    if (x >= s)
        return 0;
    const double norm = s < 1e-2 ? 3 / (s * s) : 1 / (1 - s / std::tan(s));
    return norm * std::sin(s - x) / (std::sin(s) * std::max(1e-9, std::cos(x)));
}

/// The parts of a lamp's light that arrive at a surface, and at one that faces the lamp's middle.
struct ArrivingShares {
    double surface = 0;
    double head_on = 0;
};

/// The light of an area of 1 watt, in as many parts as it is near: from its middle alone, what is
/// beside a window's frame would get nothing of the window.
ArrivingShares from_area(const Light& area, const glm::dvec3& point, const glm::dvec3& normal) {
    // The parts along an edge, for each extent over the distance.
    // Taste: more are nearer to all of the area, more slowly.
    constexpr double kPartsNear = 6;
    // The most parts along an edge.
    // Taste: these tell whether a lamp matters, and need not be exact.
    constexpr double kMostParts = 8;
    const glm::dvec3 middle = area.position - point;
    // Most lamps of a front of windows are behind a point, or it faces away from all of them.
    const auto reach = [&area](const glm::dvec3& way) {
        return 0.5 * (std::abs(glm::dot(area.edge_u, way)) + std::abs(glm::dot(area.edge_v, way)));
    };
    if (reach(area.direction) <= glm::dot(middle, area.direction) ||
        glm::dot(middle, normal) + reach(normal) <= 0)
        return {};
    const glm::dvec3 out = glm::normalize(area.direction);
    const double away = glm::length(middle);
    const glm::dvec3 to_middle = middle / std::max(away, 1e-300);
    const auto parts = static_cast<int>(std::clamp(
        std::floor(kPartsNear * extent_of(area) / std::max(away, 1e-9)), 1.0, kMostParts));
    const double size =
        glm::length(glm::cross(area.edge_u, area.edge_v)) * (area.round ? kPi / 4 : 1);
    const double part_size = size / (parts * parts);
    ArrivingShares sum;
    int count = 0;
    for (int i = 0; i < parts * parts; ++i) {
        const double u = (i % parts + 0.5) / parts - 0.5;
        const int row = i / parts;
        const double v = (row + 0.5) / parts - 0.5;
        if (area.round && u * u + v * v > 0.25)
            continue;
        ++count;
        const glm::dvec3 way = area.position + u * area.edge_u + v * area.edge_v - point;
        const double square = glm::dot(way, way);
        const double distance = std::sqrt(square);
        const double facing = glm::dot(way, normal);
        const double sent = -glm::dot(way, out) / std::max(distance, 1e-300);
        if (!(sent > 0))
            continue;
        const double part =
            sent * in_spread(area, sent) / (4 * kPi * (square + part_size / kPi) * distance);
        sum.surface += std::max(0.0, facing) * part;
        sum.head_on += std::max(0.0, glm::dot(way, to_middle)) * part;
    }
    const int divisor = std::max(count, 1);
    return {sum.surface / divisor, sum.head_on / divisor};
}

/// The light of a point or a spot of 1 watt.
ArrivingShares from_middle(const Light& light, const glm::dvec3& point, const glm::dvec3& normal) {
    const glm::dvec3 way = light.position - point;
    const double square = glm::dot(way, way);
    const double distance = std::sqrt(square);
    const double facing = glm::dot(way, normal);
    if (!(facing > 0))
        return {};
    const double r = light.radius;
    double head_on = 1 / (4 * kPi * kPi * (square + r * r + 1e-9));
    if (light.kind == LightKind::Spot) {
        const double sent = -glm::dot(way, glm::normalize(light.direction)) / distance;
        if (!(sent > 0))
            return {};
        head_on *= sent * in_cone(light, sent);
    }
    return {facing / distance * head_on, head_on};
}

}  // namespace

glm::dvec3 energy_of(const Light& light) {
    return light.color * light.power;
}

double extent_of(const Light& light) {
    if (light.kind == LightKind::Area)
        return 0.5 * glm::length(glm::abs(light.edge_u) + glm::abs(light.edge_v));
    return std::max(0.0, light.radius);
}

bool shines_as_sun(const Light& light) {
    const glm::dvec3 energy = energy_of(light);
    const double length = glm::length(light.direction);
    return light.kind == LightKind::Sun && finite(energy) && length > 0 && std::isfinite(length) &&
           std::min({energy.x, energy.y, energy.z}) >= 0;
}

bool is_lamp(const Light& light) {
    const glm::dvec3 energy = energy_of(light);
    if (light.kind == LightKind::Sun || !finite(energy) || !finite(light.position) ||
        std::min({energy.x, energy.y, energy.z}) < 0 ||
        !(std::max({energy.x, energy.y, energy.z}) > 0) || !std::isfinite(extent_of(light)))
        return false;
    if (light.kind == LightKind::Point)
        return true;
    const double length = glm::length(light.direction);
    if (!(length > 0) || !std::isfinite(length))
        return false;
    return light.kind == LightKind::Spot || glm::length(glm::cross(light.edge_u, light.edge_v)) > 0;
}

LightArrival light_arrival(const Light& light, const glm::dvec3& point, const glm::dvec3& normal) {
    const ArrivingShares shares = light.kind == LightKind::Area ? from_area(light, point, normal)
                                                                : from_middle(light, point, normal);
    const glm::dvec3 energy = energy_of(light);
    return {energy * shares.surface, energy * shares.head_on};
}

double most_in_spread(const Light& area) {
    return in_spread(area, 1);
}

double display_step(double radiance) {
    // Law: one step of an 8-bit display.
    constexpr double kStep = 1.0 / 255;
    const double shown = std::min(radiance, 1.0);
    if (!(shown > kSrgbLinearEnd))
        return kStep / kSrgbSlope;
    return kStep * kSrgbPower / kSrgbScale * std::pow(shown, 1 - 1 / kSrgbPower);
}

LightTolerance::LightTolerance(const glm::dvec3& radiance) {
    // The share of a point's light that nobody misses.
    // Taste: a quarter of a step at the brightest, and still no step in a picture exposed 4 stops up.
    constexpr double kMissed = 1.0 / 1024;
    // The part of a step of a color that is darker than the others.
    // Taste: no more than is lost by rounding.
    constexpr double kDarkStep = 0.125;
    const double brightest = std::max({radiance.x, radiance.y, radiance.z, 0.0});
    for (int i = 0; i < 3; ++i) {
        const double here = std::max(0.0, radiance[i]);
        step_[i] = display_step(here);
        least_[i] = std::max(kMissed * here, std::min(kMissed * brightest, kDarkStep * step_[i]));
    }
}

}  // namespace lodestone::light
