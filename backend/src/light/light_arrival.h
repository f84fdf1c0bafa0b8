// SPDX-License-Identifier: GPL-3.0-or-later
// Light arrival: what a light sends to a point, as it is drawn.
#pragma once

#include "model/view.h"

namespace lodestone::light {

/// Color times power: what adds up when lights are joined.
glm::dvec3 energy_of(const Light& light);
double luminance(const glm::dvec3& color);

/// Radius of what shines: 0 for a point without size; half the diagonal of an area.
double extent_of(const Light& light);

/// A lamp that can be judged at all: no sun, finite, shining, not taking light away.
bool is_lamp(const Light& light);

/// What a matte white surface that faces `normal` (unit) sends back of an unhidden lamp's light
/// (linear radiance). The lamp is taken for its middle.
glm::dvec3 arriving_radiance(const Light& light, const glm::dvec3& point, const glm::dvec3& normal);

/// Change of linear radiance that one step of an 8-bit display shows at such a radiance.
double display_step(double radiance);

}  // namespace lodestone::light
