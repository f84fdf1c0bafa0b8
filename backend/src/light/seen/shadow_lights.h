// SPDX-License-Identifier: GPL-3.0-or-later
// Shadow lights: the lights of a scene whose shadows show, suns and lamps, and which of them to
// look for from a place.
#pragma once

#include "base/random.h"
#include "model/view.h"

#include <span>
#include <vector>

namespace lodestone::light {

/// A light whose shadows show.
struct ShadowLight {
    const Light* light = nullptr;
    bool sun = true;
    glm::dvec3 way{0, 0, 1};  // of a sun: to it; has length 1
    double radius = 0;        // of a sun's disk at distance 1; of a lamp: from its middle, metres
    double strength = 0;  // of a sun: W/m^2; of a lamp: that at 1 m from it; however it is colored
};

/// The lights that throw shadows, those that take light away, too. The lights must outlive them.
std::vector<ShadowLight> shadow_lights(std::span<const Light> lights);

/// A place that is lit, and the side that it turns to lights.
struct LitPlace {
    glm::dvec3 point{0.0};
    glm::dvec3 normal{0.0};  // has length 1; 0: all sides
};

/// The light that a place gets where nothing hides it, W/m^2, about: a lamp counts as its middle.
double arriving(const ShadowLight& light, const LitPlace& place);

/// Picks lights for one place after the other: the one that lights the place most, and one of the
/// others by chance, as often as it lights, or none where they light it little. For one thread.
class LightPicker {
public:
    /// The lights must outlive it.
    explicit LightPicker(std::span<const ShadowLight> lights) : lights_(lights) {}

    /// The numbers of the lights that are picked among some (all of them where `among` is empty):
    /// none to two.
    std::span<const uint32_t> pick(const LitPlace& place, std::span<const uint32_t> among,
                                   PcgRandom& random);

private:
    std::span<const ShadowLight> lights_;
    std::vector<double> arriving_;
    uint32_t picked_[2] = {};
};

/// The way from a point to a random place on a light.
struct WayToLight {
    glm::dvec3 direction{0, 0, 1};  // has length 1
    double length = 0;              // infinite to a sun
};
WayToLight way_to(const ShadowLight& light, const glm::dvec3& point, PcgRandom& random);

}  // namespace lodestone::light
