// SPDX-License-Identifier: GPL-3.0-or-later
// Standing: stand-ins that neither sink into the plane their original stands on nor float above it.
#pragma once

#include "model/primitive.h"

namespace lodestone::solids {

/// Lowest and highest point along Z.
struct HeightRange {
    double low = 0;
    double high = 0;
};
HeightRange reach_of(const Primitive& primitive, bool box);

/// The same top and surface area, but the lowest point at `floor`: heights are stretched, what that
/// does to the area is taken from the width, and of what is tilted also from the top. Only moved
/// where it would have to be stretched to more than twice or half its size; unchanged where the top
/// is not above the floor. source: 4.3 (constrained replacements are named there, not given)
Primitive standing_on(const Primitive& primitive, bool box, double floor);

/// standing_on() for what reaches below the floor, anything else unchanged. What lies below it
/// entirely is lifted.
Primitive kept_above(const Primitive& primitive, bool box, double floor);

}  // namespace lodestone::solids
