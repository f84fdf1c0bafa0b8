// SPDX-License-Identifier: GPL-3.0-or-later
// Visible solids: what can be seen of boxes and ellipsoids that hide parts of each other.
#pragma once

#include "base/job.h"
#include "measure/visible/surface_inertia.h"
#include "model/composite.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace lodestone::solids {

/// Area, center and second moments of what of opaque solids can be seen from outside. Of whole
/// surfaces all that is exact; what is hidden of it is found by rays that leave them, which meet
/// ellipsoids and boxes as they are: no triangles, no tree. The rays of two calls are the same
/// ones, so results of solids that differ little differ little. The same bits on any number of
/// threads.
class VisibleSolids {
public:
    VisibleSolids(uint32_t rays, uint64_t seed);

    /// `share` of all rays, the first ones. `each`: also of every solid by itself, hidden as it is
    /// (empty where nothing of it is seen).
    measure::SurfaceInertia of(const Composite& composite, double share, const Job& job,
                               std::vector<measure::SurfaceInertia>* each = nullptr) const;

private:
    struct LeavingRay {
        float at = 0;                       // of all area, 0...1
        float across = 0;                   // of a face, 0...1
        glm::vec2 around{1.0f, 0.0f};       // of a ball: cosine and sine
        glm::vec3 along{0.0f, 0.0f, 1.0f};  // where it leaves to, around the normal (cosine)
    };
    std::vector<LeavingRay> rays_;
};

}  // namespace lodestone::solids
