// SPDX-License-Identifier: GPL-3.0-or-later
// Primitive distance: how far points are from the surface of a box or an ellipsoid, exactly.
#pragma once

#include "model/primitive.h"

namespace lodestone {

/// The distance in metres from a point to the surface, also from inside, to about 1e-9 of the
/// distance and the largest half size; half sizes may be 0. Not finite where the point is not. Any
/// thread.
double distance_to_box(const Primitive& box, const glm::dvec3& point);

/// The same for an ellipsoid. The nearest point x solves x_i (1 + t / a_i^2) = p_i for the largest
/// t at which it lies on the ellipsoid of half sizes a.
double distance_to_ellipsoid(const Primitive& ellipsoid, const glm::dvec3& point);

}  // namespace lodestone
