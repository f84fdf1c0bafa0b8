// SPDX-License-Identifier: GPL-3.0-or-later
// Light coverage: whatever a picture shows is spoken for by a lit point that sees it, so that no part
// of a thing is left without the lamps of its room.
#pragma once

#include "povray_export/light_regions.h"
#include "povray_export/lit_points.h"

namespace lodestone::povray {

/// Something seen, and the point that speaks for it.
struct Sighting {
    glm::dvec3 position{0.0};
    uint32_t drawn = 0;
    uint32_t point = 0;
};

/// Looks through every pixel up to four times, half a million times in all, more where a look
/// is alone, at most twice as many. What no point beside it sees (reach_beside), of the same thing and facing about its
/// way, is alone and becomes a point itself, at most as many as there are (then evenly chosen ones).
/// Sightings are those of things that `divisible` allows to be cut. The
/// same on any number of threads. cost: two rays a look.
std::vector<Sighting> cover(const LitScene& scene, const View& view,
                            std::span<const uint8_t> divisible, LitGrid& grid, const Job& job);

/// Where a thing is cut between a sighting and its point, lends the point to the piece that is seen:
/// copies of it in that region, and of its shares.
void lend(std::span<const Sighting> sightings, const LightRegions& regions,
          std::vector<quality::LitPoint>& points, quality::LightShares& shares);

}  // namespace lodestone::povray
