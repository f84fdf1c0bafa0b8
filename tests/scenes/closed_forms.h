// SPDX-License-Identifier: GPL-3.0-or-later
// Closed forms: area and second moments of primitives (dissertation A.10-A.19), to test against.
#pragma once

#include "measure/visible/surface_inertia.h"

namespace lodestone::closed_forms {

using measure::SurfaceInertia;

// About the origin; lengths in metres, >= 0 and finite.
SurfaceInertia of_sphere(double radius);                          // A.10, A.11
SurfaceInertia of_box(double a, double b, double c);              // A.12-A.14 with 1/12 in A.13
SurfaceInertia of_closed_cylinder(double radius, double height);  // A.15-A.17, axis z
SurfaceInertia of_disc(double radius);                            // A.18, A.19, normal z, one side
SurfaceInertia of_ellipsoid(const glm::dvec3& half_size);         // by quadrature, to 1e-10

}  // namespace lodestone::closed_forms
