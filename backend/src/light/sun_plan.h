// SPDX-License-Identifier: GPL-3.0-or-later
// Sun plan: by how many shadow rays the size of a sun is sampled for each thing, from the penumbrae
// that a view shows on it.
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

/// By thing and sun: the fewest rays along an edge with which light is hardly anywhere on the thing
/// farther off than the narrowest penumbra. A point lies in a penumbra where something hides a part of the sun from it; it is as wide
/// as the sun looks from there, farthest away. A thing with few points has as many as all such
/// things together need, one without points one. `points[i].region` is the thing. Any number of
/// threads gives the same result. cost: 6 rays a point and sun
std::vector<std::vector<int>> fit_sun_rays(const LitScene& scene, std::span<const LitPoint> points,
                                           std::span<const Light> suns, size_t things,
                                           const View& view, const GridDemands& demands,
                                           const Job& job = {});

/// Adds suns to the groups of a plan, or makes one of them alone where it is empty: things that need
/// other numbers of rays come into other groups, where that is worth it. `rays` are those of
/// fit_sun_rays(), `points` as there.
void add_suns(LightPlan& plan, std::span<const Light> lights, std::span<const uint32_t> suns,
              const std::vector<std::vector<int>>& rays, std::span<const uint32_t> points);

}  // namespace lodestone::light
