// SPDX-License-Identifier: GPL-3.0-or-later
// Ring simplification: closed outlines with fewer corners and the same area.
#pragma once

#include "geometry/level_rings.h"

namespace lodestone {

/// A rectangle from (0, 0). Points of rings that are exactly on its border stay.
struct RingFrame {
    double width = 0;
    double height = 0;
};

/// The ring with fewer corners: two neighbors become one as long as all points of the given ring
/// stay within `tolerance` of the new one, the cheapest first. Every step keeps the area to
/// rounding, as far as three corners can. Points between others on one straight line, and on a side
/// of the frame between others of the same side, are dropped. The result may touch or cross itself
/// or others where these are nearer to each other than the tolerance. cost: O(n log n) for outlines
/// that turn everywhere. source: Kronenfeld, Stanislawski, Buttenfield, Brockmeyer: Simplification
/// of polylines by segment collapse: minimizing areal displacement while preserving area (2020)
Ring simplified(const Ring& ring, double tolerance, const RingFrame& frame);

}  // namespace lodestone
