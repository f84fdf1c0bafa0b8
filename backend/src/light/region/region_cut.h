// SPDX-License-Identifier: GPL-3.0-or-later
// Region cut: the boxes into which things are cut, so that the points of each are lit by few lamps.
#pragma once

#include "light/light_cut.h"

#include <span>
#include <vector>

namespace lodestone::light {

/// A box, and those points of a thing that are in it.
struct CutBox {
    Box3 box;
    std::vector<uint32_t> points;
};

/// Cuts the box of each thing into at most 128, where that saves most shadow rays first; into one
/// where it saves few. A cut runs where the light of a lamp begins or ends, and where points lie far
/// apart. A box is lit by the lamps of all points that stand for places in it, and to a part by
/// those of points beside. Where more than a hundred shadow rays go to lamps that shine everywhere,
/// boxes are halved, into at most 32. `weights`: the shadow rays to each lamp. `spoken`: by point,
/// the places that it stands for. Any number of threads gives the same result. cost: n log n for
/// each cut.
std::vector<std::vector<CutBox>> cut_things(std::span<const CutBox> things,
                                            std::span<const double> weights,
                                            const LightShares& shares, std::span<const Box3> spoken,
                                            std::span<const LitPoint> points);

}  // namespace lodestone::light
