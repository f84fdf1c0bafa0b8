// SPDX-License-Identifier: GPL-3.0-or-later
// Sky means: the share of a uniform sky that a whole surface sees, where it is placed and alone.
#pragma once

#include "light/sky/sky_sampler.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lodestone::light {

/// The means, over the surface, of the shares of the whole request and of the surface alone, by so
/// many rays.
struct SkyMeans {
    double placed = 1;
    double alone = 1;
};
SkyMeans mean_sky_shares(const SkyRequest& request, int rays);

/// The means of a list of placements as bytes that are kept, and back; none where they are damaged.
std::string bytes_of(const std::vector<SkyMeans>& means);
std::optional<std::vector<SkyMeans>> means_of(std::string_view bytes, size_t count);

}  // namespace lodestone::light
