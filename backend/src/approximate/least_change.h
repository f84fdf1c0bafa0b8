// SPDX-License-Identifier: GPL-3.0-or-later
// Least change: what to do to solids so that together they show what is wanted.
#pragma once

#include "measure/surface_inertia.h"
#include "model/attributes.h"
#include "model/composite.h"

#include <vector>

namespace lodestone::approximate {

/// What is missing of what is seen of the whole: shares of the area, radii of gyration, variances
/// over their trace (of their ratios alone, where the size is not asked for).
struct Missing {
    double area = 0;
    glm::dvec3 centroid{0.0};
    glm::dmat3 variances{0.0};
};
Missing missing_of(const measure::SurfaceInertia& now, const Attributes& wanted, bool size);

/// Moves every solid and stretches it along its own axes, altogether as little as possible, so that
/// what is missing is made up for, were each to hide as much of the others as before: one step of
/// Gauss and Newton of least norm, in ten numbers of the whole and six unknowns of every solid.
/// Where a solid would sink below `floor` it stands there, and the others do more. `each`: what is
/// seen of each. No step is larger than half of a solid or of the radius of gyration.
void make_up(Composite& composite, const measure::SurfaceInertia& now,
             const std::vector<measure::SurfaceInertia>& each, const Missing& missing, bool size,
             double floor);

}  // namespace lodestone::approximate
