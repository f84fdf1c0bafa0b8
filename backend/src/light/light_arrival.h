// SPDX-License-Identifier: GPL-3.0-or-later
// Light arrival: the light that a lamp sends to a point, as it is drawn.
#pragma once

#include "model/view.h"

#include <glm/common.hpp>

namespace lodestone::light {

/// The color times the power, which add up when lights are joined.
glm::dvec3 energy_of(const Light& light);

/// The radius of the shining surface: 0 for a point without size; half the diagonal of an area.
double extent_of(const Light& light);

/// Whether a light is a sun that can be judged: finite, not taking light away.
bool shines_as_sun(const Light& light);

/// Whether a light is a lamp that can be judged: no sun, finite, shining, not taking light away.
bool is_lamp(const Light& light);

/// The light of an unhidden lamp that a matte white surface sends back (linear radiance).
struct LightArrival {
    glm::dvec3 surface{0.0};
    glm::dvec3 head_on{0.0};  // if the surface faced the lamp's middle
};
/// That of a surface facing `normal` (unit). A lamp counts as if all of it were at its middle, an
/// area that is near as a few parts. Of a lamp that is all behind the surface nothing arrives.
LightArrival light_arrival(const Light& light, const glm::dvec3& point, const glm::dvec3& normal);

/// How many times as much light an area sends along its axis as without a spread.
double most_in_spread(const Light& area);

/// The change of linear radiance that one step of an 8-bit display shows at this radiance.
double display_step(double radiance);

/// By how much each color may be off at a point that sends a radiance to the eye: by `pixel_error`
/// steps of an 8-bit display, and never less than a 1024th of it. A color that is darker than the
/// others may be off by a 1024th of the brightest, if that is less than an eighth of a step.
/// Brighter points may be off by more.
class LightTolerance {
public:
    explicit LightTolerance(const glm::dvec3& radiance);
    glm::dvec3 at(double pixel_error) const { return glm::max(least_, pixel_error * step_); }

private:
    glm::dvec3 step_{0.0};
    glm::dvec3 least_{0.0};
};
inline glm::dvec3 light_tolerance(const glm::dvec3& radiance, double pixel_error) {
    return LightTolerance(radiance).at(pixel_error);
}

}  // namespace lodestone::light
