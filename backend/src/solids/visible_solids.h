// SPDX-License-Identifier: GPL-3.0-or-later
// Visible solids: the visible surface of boxes and ellipsoids that hide parts of each other.
#pragma once

#include "base/job.h"
#include "measure/visible/surface_inertia.h"
#include "model/composite.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace lodestone::solids {

/// The area, center and second moments of the surface of opaque solids that can be seen from
/// outside. Those of whole surfaces are exact. The hidden part is found by rays that leave the
/// surfaces and meet ellipsoids and boxes as they are: no triangles, no tree. The rays of two calls
/// are the same, so solids that differ little give results that differ little. Any number of
/// threads gives the same bits.
class VisibleSolids {
public:
    VisibleSolids(uint32_t rays, uint64_t seed);

    /// `share`: the share of all rays that is used, the first ones. `each`: gets the same of every
    /// solid by itself, hidden as it is (empty where nothing of it is seen).
    measure::SurfaceInertia of(const Composite& composite, double share, const Job& job,
                               std::vector<measure::SurfaceInertia>* each = nullptr) const;

private:
    struct LeavingRay {
        float at = 0;                  // the place in all area, 0...1
        float across = 0;              // the place across a face, 0...1
        glm::vec2 around{1.0f, 0.0f};  // the place around a ball: cosine and sine
        /// The direction it leaves to, around the normal (by the cosine).
        glm::vec3 along{0.0f, 0.0f, 1.0f};
    };
    std::vector<LeavingRay> rays_;
};

}  // namespace lodestone::solids
