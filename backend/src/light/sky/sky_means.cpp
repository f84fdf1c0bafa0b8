// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/sky/sky_means.h"

#include <algorithm>
#include <cstring>

namespace lodestone::light {
namespace {

/// The sums of some rays.
struct MeanSums {
    double placed = 0;
    double alone = 0;
    double rays = 0;
};

/// The sums of the rays to both sides of leaves.
struct LeafSums {
    MeanSums side[2];
    int count = 0;

    /// By how much leaves have more than the mean of their sides, in sums.
    double more(double MeanSums::*sum) const {
        if (!(side[0].rays > 0 && side[1].rays > 0))
            return 0;
        const double factor = of_side_that_is_seen(side[0].*sum / side[0].rays,
                                                   side[1].*sum / side[1].rays, 0.5 * count);
        return (factor - 1) * (side[0].*sum + side[1].*sum);
    }
};

}  // namespace

SkyMeans mean_sky_shares(const SkyRequest& request, int rays) {
    const SkySampler sampler(request);
    const Mesh& mesh = *request.surface.mesh;
    const std::vector<double>& areas = request.surface.areas;
    const double sum = areas.empty() ? 0 : areas.back();
    SkyMeans out;
    if (!(sum > 0) || rays < 1)
        return out;
    const ray::FlushDenormals fast;
    MeanSums all;
    MeanSums inside;
    LeafSums leaves;
    uint32_t blocker = ray::PlacedScenes::kNothing;
    uint32_t near = ray::kNoTriangle;
    for (int i = 0; i < rays; ++i) {
        const double area = sum * (i + 0.5) / rays;
        const size_t triangle =
            static_cast<size_t>(std::lower_bound(areas.begin(), areas.end(), area) - areas.begin());
        if (triangle >= areas.size())
            continue;
        const std::optional<SkySampler::PlacedTriangle> placed = sampler.placed(mesh, triangle);
        if (!placed)
            continue;
        const bool both = !request.surface.opaque_slot(mesh.slot(triangle));
        // Rays are as dense as the surface is before it is placed, which may stretch some of it.
        const double own = areas[triangle] - (triangle > 0 ? areas[triangle - 1] : 0);
        const double weight = own > 0 ? placed->area / own : 0;
        // Every second point of the sequence lies in one half of its first axis: both sides have
        // all points.
        const SkySampler::SkyPlace place =
            sampler.place(mesh, triangle, *placed, static_cast<uint32_t>(both ? i / 2 : i), near);
        const SkySampler::SkyRay ray = sampler.ray(place, both && i % 2 == 1);
        const double alone = ray.open && !sampler.hidden_alone(ray) ? 1 : 0;
        const double seen = alone > 0 && !sampler.hidden(ray, blocker) ? 1 : 0;
        all.placed += weight * seen;
        all.alone += weight * alone;
        all.rays += weight;
        if (both) {
            MeanSums& side = leaves.side[i % 2];
            side.placed += weight * seen;
            side.alone += weight * alone;
            side.rays += weight;
            ++leaves.count;
        }
        if (seen == 0 && !both && sampler.lies_inside(mesh, triangle, *placed)) {
            inside.alone += weight * alone;
            inside.rays += weight;
        }
    }
    if (inside.rays < all.rays) {
        all.alone -= inside.alone;
        all.rays -= inside.rays;
    }
    if (all.rays > 0) {
        out.alone = std::min(1.0, (all.alone + leaves.more(&MeanSums::alone)) / all.rays);
        out.placed = std::min(out.alone, (all.placed + leaves.more(&MeanSums::placed)) / all.rays);
    }
    return out;
}

std::string bytes_of(const std::vector<SkyMeans>& means) {
    std::string out(means.size() * 2 * sizeof(float), '\0');
    for (size_t i = 0; i < means.size(); ++i) {
        const float pair[] = {static_cast<float>(means[i].placed),
                              static_cast<float>(means[i].alone)};
        std::memcpy(out.data() + i * sizeof pair, pair, sizeof pair);
    }
    return out;
}

std::optional<std::vector<SkyMeans>> means_of(std::string_view bytes, size_t count) {
    float pair[2];
    if (bytes.size() != count * sizeof pair)
        return {};
    std::vector<SkyMeans> out(count);
    for (size_t i = 0; i < count; ++i) {
        std::memcpy(pair, bytes.data() + i * sizeof pair, sizeof pair);
        // Things around another one hide more of its sky, never less.
        if (!(pair[0] >= 0 && pair[0] <= pair[1] && pair[1] <= 1))
            return {};
        out[i] = {pair[0], pair[1]};
    }
    return out;
}

}  // namespace lodestone::light
