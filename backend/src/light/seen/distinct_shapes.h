// SPDX-License-Identifier: GPL-3.0-or-later
// Distinct shapes: which of the drawn things are the same representation, made ready for rays once.
#pragma once

#include "light/light_plan.h"

#include <span>
#include <vector>

namespace lodestone::light {

struct DistinctShapes {
    std::vector<uint32_t> of_thing;  // by drawn thing: the number of its shape
    std::vector<uint32_t> firsts;    // by shape: the first thing of it
};

/// The shapes of drawn things, numbered as they are first met.
DistinctShapes distinct_shapes(std::span<const DrawnThing> drawn);

}  // namespace lodestone::light
