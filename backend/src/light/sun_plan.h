// SPDX-License-Identifier: GPL-3.0-or-later
// Sun plan: by how many shadow rays the size of a sun is sampled, from the penumbrae that a view
// shows.
// One number for all things: POV-Ray casts the rays to a sun of a light_group anew for each texture
// of each corner, which takes longer than a group of things with sharp shadows could save.
#pragma once

#include "light/light_plan.h"
#include "light/lit_points.h"

namespace lodestone::light {

/// The rays along an edge of a sun's grid that are never exceeded: fewer where it is as small as
/// the real one. `rays`: along the edge of a large lamp; 1: all shadows are sharp.
int finest_sun_rays(const Light& sun, int rays);

/// The shadow rays that a sun costs at a point in the mean.
double sun_shadow_rays(int rays);

/// The suns, by their numbers, whose penumbrae somewhere could be wider than the narrowest one that
/// shows, by the bounds of all things (widest_penumbra()): the others need no look.
std::vector<uint32_t> soft_suns(std::span<const Light> lights, const View& view,
                                const GridDemands& demands, std::span<const Bound> bounds);

/// The fewest rays along an edge with which the view hardly anywhere shows a step, or one where all
/// penumbrae are too narrow to show. A point lies in a penumbra where something hides a part of
/// the sun from it; it is as wide as the sun looks from there, farthest away. Any number of threads
/// gives the same result. cost: 6 rays a point
int fit_sun_rays(const LitScene& scene, std::span<const LitPoint> points, const Light& sun,
                 const View& view, const GridDemands& demands, const Job& job = {});

}  // namespace lodestone::light
