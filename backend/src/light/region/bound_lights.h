// SPDX-License-Identifier: GPL-3.0-or-later
// Bound lights: the lamps of things of which nothing is known but where they are, for the picture
// shows so little of them that no lit point lies on any.
#pragma once

#include "model/view.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lodestone::light {

/// Neighboring things that are lit by the same lamps.
struct BoundGroup {
    std::vector<uint32_t> things;
    std::vector<uint32_t> lamps;  // rising
};

/// More than the linear radiance of a matte white surface anywhere within a bound, from a lamp that
/// nothing hides. Infinite where the lamp touches the bound.
glm::dvec3 most_radiance(const Light& lamp, const Bound& bound);

/// Divides things into groups with short lists of lamps. The lamps that a list lacks are together
/// worth no more on any surface of the group than what a black point may be off by
/// (light_tolerance), highlights excepted. `bounds`: of all things, in the frame of the lamps;
/// `things`: the indices of those to divide. cost: things x lamps, a dozen times; where that is more
/// than two million, all are one group.
std::vector<BoundGroup> group_by_bounds(std::span<const Light* const> lamps,
                                        std::span<const Bound> bounds, std::vector<uint32_t> things,
                                        double pixel_error);

}  // namespace lodestone::light
