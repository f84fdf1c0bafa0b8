// SPDX-License-Identifier: GPL-3.0-or-later
// Visible solids: what can be seen of boxes and ellipsoids that hide parts of each other.
#pragma once

#include "base/job.h"
#include "measure/surface_inertia.h"
#include "model/composite.h"

#include <array>
#include <cstdint>
#include <vector>

namespace lodestone::approximate {

/// Area, center and second moments of what of opaque solids can be seen from outside. Of whole
/// surfaces all that is exact; what is hidden of it is found by rays that leave them, which meet
/// ellipsoids and boxes as they are: no triangles, no tree. The rays of two calls are the same ones,
/// so results of solids that differ little differ little. The same bits on any number of threads.
class VisibleSolids {
public:
    VisibleSolids(uint32_t rays, uint64_t seed);

    /// `share` of all rays, the first ones.
    measure::SurfaceInertia of(const Composite& composite, double share, const Job& job) const;

private:
    std::vector<std::array<float, 4>> numbers_;
};

}  // namespace lodestone::approximate
