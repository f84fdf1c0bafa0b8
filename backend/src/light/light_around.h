// SPDX-License-Identifier: GPL-3.0-or-later
// Light around: the light that lit surfaces send to things, which a rough metal shows.
#pragma once

#include "light/lit_points.h"

namespace lodestone::light {

/// A drawn thing of which the light around it is asked for, and the rays that tell it.
struct AroundRequest {
    uint32_t drawn = 0;
    int rays = 64;
};

/// The mean radiance (linear) of the surfaces around each thing, as all of its own surface faces
/// them: of what lamps, suns and the sky of `demands` send to them, and they send on to the thing.
/// Directions in which nothing is seen count as black, for the sky itself is not in it, nor is what
/// glows. The same for equal arguments, on any number of threads. Throws Error(RaysUnavailable,
/// Cancelled). cost: a ray, one to a lamp and one to each sun, for each ray that is asked for
std::vector<glm::dvec3> light_around(const Model& model, const RendererSurfaces& renderer,
                                     std::span<const DrawnThing> drawn,
                                     std::span<const AroundRequest> requests,
                                     const LightDemands& demands, const Job& job);

}  // namespace lodestone::light
