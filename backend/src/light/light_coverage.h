// SPDX-License-Identifier: GPL-3.0-or-later
// Light coverage: makes sure that every point a picture shows has a lit point near it that sees it,
// so that no part of a thing is left without the lamps of its room.
#pragma once

#include "light/lit_points.h"
#include "light/region/light_regions.h"

namespace lodestone::light {

/// A point that is seen, and the lit point that stands for it.
struct PointSighting {
    glm::dvec3 position{0.0};
    uint32_t drawn = 0;
    uint32_t point = 0;
};

/// Looks through every pixel of the wanted cells once, half a million times in all. A point that is
/// seen is alone if no lit point of the same thing, near it (reach_beside) and facing about the same way,
/// sees it. Around it there are more looks (at most twice as many in all), and points that are
/// alone become lit points, at most as many as there were (then evenly chosen ones). Returns the
/// sightings of things that `divisible` allows to be cut. Any number of threads gives the same
/// result. cost: two rays a look.
std::vector<PointSighting> add_missing_lit_points(const LitScene& scene, const View& view,
                                                  std::span<const uint8_t> divisible,
                                                  std::span<const uint8_t> wanted, LitGrid& grid,
                                                  const Job& job);

/// By point of `count`: the places that were seen and that it stands for.
std::vector<Box3> spoken_boxes(std::span<const PointSighting> sightings, size_t count);

/// Lends points where a thing is cut between a sighting and its point: the piece that is seen gets
/// copies of the point in its region, at the nearest place where it was seen, and of its shares.
void lend_lit_points(std::span<const PointSighting> sightings, const LightRegions& regions,
                     std::vector<LitPoint>& points, LightShares& shares);

}  // namespace lodestone::light
