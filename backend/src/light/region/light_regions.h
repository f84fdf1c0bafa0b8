// SPDX-License-Identifier: GPL-3.0-or-later
// Light regions: the parts of a scene that are lit by the same lights.
#pragma once

#include "light/light_cut.h"
#include "light/light_plan.h"

namespace lodestone::light {

struct LightRegions {
    size_t count = 0;
    /// In the order of the drawn things; `group` is the region, or none where no point lies.
    std::vector<LitPiece> pieces;
};
inline constexpr uint32_t kNoRegion = ~uint32_t{0};

/// Sets the regions of points. `points[i].region` is the index of the thing that the point lies on,
/// and becomes its region. Things with many points are regions of their own, those with few join
/// their neighbors. A thing that `divisible` allows is cut where that makes shorter lists of lamps
/// for its points (where the light of lamps ends, too), into at most 128 boxes that fill its bound;
/// where very many lamps light all of it, into at most 32.
/// `weights`: the shadow rays to each lamp. `spoken`: by point, where it stands for what is seen; a
/// box is lit by the lamps of all points that do so within it.
LightRegions make_light_regions(std::span<const Bound> bounds, std::span<const uint8_t> divisible,
                                std::span<const double> weights, const LightShares& shares,
                                std::span<const Box3> spoken, std::vector<LitPoint>& points);

}  // namespace lodestone::light
