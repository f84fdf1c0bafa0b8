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
    glm::dvec3 way{0, 0, 1};  // of a sun: to it; of a spot or an area: where it shines; unit
    double radius = 0;        // of a sun's disk at distance 1; of a lamp: from its middle, metres
    double strength = 0;      // of a sun: W/m^2; of a lamp: that at 1 m from it; of any color
    double cone_cosine = 0;   // of a spot or an area: it shines where that of its angle is more
};

/// The lights that throw shadows, those that take light away, too. The lights must outlive them.
std::vector<ShadowLight> shadow_lights(std::span<const Light> lights);

/// The light that a point gets where nothing hides it, W/m^2, about: a lamp counts as its middle.
/// `normal`: the side that it turns to lights, of length 1; 0: all sides. Not light_arrival(),
/// which asks an area for up to 64 parts, and needs a side.
double arriving(const ShadowLight& light, const glm::dvec3& point, const glm::dvec3& normal);

/// Picks lights for one point after the other: the one that lights it most, and one of the others by
/// chance, as often as it lights, or none where they light it little. For one thread.
class LightPicker {
public:
    /// The lights must outlive it.
    explicit LightPicker(std::span<const ShadowLight> lights) : lights_(lights) {}

    /// The numbers of the lights that are picked among some (all of them where `among` is empty):
    /// none to two. `normal`: as for arriving().
    std::span<const uint32_t> pick(const glm::dvec3& point, const glm::dvec3& normal,
                                   std::span<const uint32_t> among, PcgRandom& random);

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
