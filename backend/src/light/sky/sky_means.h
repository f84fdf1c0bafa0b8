// SPDX-License-Identifier: GPL-3.0-or-later
// Sky means: the share of a uniform sky that a whole surface sees, where it is placed and alone.
#pragma once

#include "light/sky/sky_sampler.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lodestone::light {

/// The means, over the surface, of the shares of the whole request and of the surface alone.
struct SkyMeans {
    double placed = 1;
    double alone = 1;
    /// The change of placed / alone over the surface, by metre of its own frame: what is around a
    /// tree hides more from its stem than from its crown. Few rays tell of flatter ones.
    glm::dvec3 slope{0.0};
    glm::dvec3 middle{0.0};  // own frame: the place where it is the mean
};
/// Those that so many rays tell.
SkyMeans mean_sky_shares(const SkyRequest& request, int rays);

/// The means of the placements of one surface, and what they stand on.
struct PlacedMeans {
    SkyHorizon horizon;  // that they were found with
    std::vector<SkyMeans> means;

    /// Bytes that are kept, and back; none where they are damaged.
    std::string bytes() const;
    static std::optional<PlacedMeans> of_bytes(std::string_view bytes, size_t count);
};

}  // namespace lodestone::light
