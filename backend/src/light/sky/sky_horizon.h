// SPDX-License-Identifier: GPL-3.0-or-later
// Sky horizon: how much of the sky below a thing what it stands on leaves to its placements.
#pragma once

#include "light/sky/sky_scene.h"

#include <glm/geometric.hpp>

#include <span>

namespace lodestone::light {

/// The sky below a thing, for shares of the thing alone: a tree's leaves see the ground under them
/// wherever the tree stands, not half a sky.
struct SkyHorizon {
    glm::dvec3 up{0.0, 0.0, 1.0};  // unit, own frame: an axis of it
    double below = 1;              // the part of the sky below that is seen; 1: there is no ground
    bool upright = false;          // all placements have this axis up

    /// Whether a direction (own frame, any length) points below it.
    bool down(const glm::dvec3& direction) const { return glm::dot(direction, up) < 0; }
};

/// The horizon of a surface that stands at all of `places`: of their rays below it, and of these as
/// far as the surface alone lets them pass, those that nothing of `scene` hides, in quarters, so that
/// a thing more in the scene seldom changes it. There is no ground where the placements do not all
/// stand about upright. cost: at most 3,072 rays, and a SkySampler for each of 64 placements
SkyHorizon sky_horizon(const SkySurface& surface, std::span<const Affine> places,
                       const SkyScene& scene);

}  // namespace lodestone::light
