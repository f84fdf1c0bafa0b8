// SPDX-License-Identifier: GPL-3.0-or-later
// Sky visibility: the share of a uniform sky that the corners of a mesh see, weighted by cosine.
#pragma once

#include "light/sky/sky_sampler.h"
#include "light/sky/sky_shares.h"

namespace lodestone::light {

/// The shares of all corners. Each triangle's rays begin all over it. What they tell goes to the
/// corners as far as these are near, so that the mean of the surface is kept, and corners at one
/// place that face the same way share one number. An opaque triangle's share is that of its front,
/// with half of its back's where that is dark and the mesh is open, or of its back, where that is
/// what is seen; one with masks or clear
/// materials (leaves) has that of the side that is seen: each as often as it is open. Triangles that
/// lie inside of something opaque tell nothing to corners that others share. A level has the light
/// of its original: rays begin at the places of that which it shows, facing alike. The result does
/// not depend on the number of threads. cost: `rays` rays a vertex, and a quarter more for splits
SkyShares sky_shares(const SkyRequest& request, const Job& job);

}  // namespace lodestone::light
