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

/// The surfaces that a thing faces, all over it.
struct LightAround {
    glm::dvec3 radiance{0.0};  // linear: the mean of the surfaces that it faces
    double part = 0;  // 0...1: of all directions those in which there are some, by the cosine
};

/// The surfaces around each thing, with what lamps, suns and the sky of `demands` send to them, and
/// they send on to the thing; not with what glows. The same for equal arguments, on any number of
/// threads. Throws Error(RaysUnavailable, Cancelled). cost: a ray, one to a lamp and one to each sun,
/// for each ray that is asked for
std::vector<LightAround> light_around(const Model& model, const RendererSurfaces& renderer,
                                      std::span<const DrawnThing> drawn,
                                      std::span<const AroundRequest> requests,
                                      const LightDemands& demands, const Job& job);

}  // namespace lodestone::light
