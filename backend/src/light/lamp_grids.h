// SPDX-License-Identifier: GPL-3.0-or-later
// Lamp grids: by how many shadow rays the size of a lamp is sampled for what it lights: one far
// away, a grid near by.
#pragma once

#include "light/light_cut.h"

#include <functional>

namespace lodestone::light {

/// How the size of a light is sampled for a part of a picture.
struct LampGrid {
    int rays = 1;        // along its longer edge; 1: one shadow ray, to its middle
    bool parts = false;  // each part of it lights by its own distance and angle
    bool soft = false;   // its soft shadows show: its corners alone would miss thin things

    // NOLINTNEXTLINE(modernize-use-nullptr)
    auto operator<=>(const LampGrid&) const = default;
};

/// How finely lamps are sampled.
struct GridDemands {
    double pixel_error = 0;   // steps of an 8-bit display
    double shadow_error = 0;  // pixels: narrower penumbrae are sharp
    int rays = 17;            // along the edge of a large lamp, at most; 1: all shadows are sharp
    double apart = 0;         // pixels between points; what lies between may be nearer to a lamp
};

/// The pixels of the narrowest penumbra that shows.
/// Taste: antialiasing shows no less; a larger value draws more shadows sharp.
inline constexpr double kLeastPenumbra = 0.25;

/// The number of rays along an edge, as it can be drawn: 2^n + 1, for POV-Ray refines by halving,
/// or 2; `most` at most.
int grid_rays(double wanted, int most);

/// The grid by which a light is sampled where nothing is known of what it lights.
LampGrid finest_grid(const Light& light, int rays);

/// The rays along the shorter edge for this number along the longer one.
int shorter_edge(const Light& light, int rays);

/// The shadow rays that a light costs at a point in the mean. POV-Ray begins with 3 x 3, of points
/// and where no soft shadow shows with 2 x 2, and casts more where these disagree.
double shadow_rays(const Light& light, const LampGrid& grid);

/// Whether a part of a light, and not all of it, reaches a point.
using IsSoft = std::function<bool(const Light&, const LitPoint&)>;

/// By region, in the order of its lights: the coarsest grids that show no step but at few points,
/// of which only those in soft edges count. Along an edge there is a ray for every three pixels of the penumbra that can be told apart, or
/// for every two steps of an 8-bit display that the light is worth at the point (half a row of rays
/// is then one step), whichever is less; and as many as keep its unhidden light within half a step
/// where it is near and wide. Never more than finest_grid(). Any number of threads gives the same
/// result.
std::vector<std::vector<LampGrid>> fit_lamp_grids(const LightTree& tree, const LightCut& cut,
                                                  std::span<const LitPoint> points,
                                                  const LightShares& shares, const IsSoft& soft,
                                                  const View& view, const GridDemands& demands,
                                                  const Job& job = {});

}  // namespace lodestone::light
