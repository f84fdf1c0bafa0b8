// SPDX-License-Identifier: GPL-3.0-or-later
// Keep on floor: stand-ins that neither sink into the plane their original stands on nor float
// above it.
#pragma once

#include "model/primitive.h"

namespace lodestone::solids {

/// The lowest and the highest point along Z.
struct HeightRange {
    double low = 0;
    double high = 0;
};
HeightRange reach_of(const Primitive& primitive, bool box);

/// The primitive with the same top and surface area, but with its lowest point at `floor`. Heights
/// are stretched; the change of area is taken from the width, and for a tilted primitive from the
/// top, too. It is only moved where it would have to be stretched to more than twice or less than
/// half its size, and unchanged where the top is not above the floor. source: 4.3 (constrained
/// replacements are named there, not given)
Primitive standing_on(const Primitive& primitive, bool box, double floor);

/// standing_on() for a primitive that reaches below the floor, any other unchanged. A primitive
/// that lies below it entirely is lifted.
Primitive kept_above(const Primitive& primitive, bool box, double floor);

}  // namespace lodestone::solids
