// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/sun_plan.h"

#include "base/parallel.h"
#include "choose/criterion.h"
#include "light/light_arrival.h"
#include "light/penumbra.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

namespace lodestone::light {
namespace {

/// The half angle in radians of a sun whose penumbra is a few pixels.
/// Taste: twice the real sun's; a larger value casts fewer rays for more suns.
constexpr double kNarrowSun = 0.009;
/// The rays along an edge of such a sun.
/// Taste: a larger value has smoother shadows of it where something is very near.
constexpr int kNarrowRays = 5;
/// The rays along an edge from which on a ray stands for more, kPenumbraeOfManyRays.
/// Taste: a larger value has smoother shadows of wide suns, for time that grows with its square.
constexpr double kFewRays = 3;
/// The narrowest penumbrae that show, side by side in one, for which one of many rays stands: the
/// rays of a grid that is turned hide one after the other along most edges, so that a penumbra has
/// many more steps than an edge of the grid has rays.
/// Taste: beneath a sun 11 degrees wide 9 x 9 rays are then as far from 33 x 33 as 17 x 17 are in a
/// grid along the edges of boxes; a larger value shows steps.
constexpr double kPenumbraeOfManyRays = 6;
/// The rays that POV-Ray casts to a grid before it decides whether it needs the others.
/// Law: its corners (adaptive 0).
constexpr double kCorners = 4;
/// The share of the others that it casts.
/// Fitted: a garden of leaves casts 8 of 25 and 5 of 9.
constexpr double kRefinedSun = 0.2;

double narrowest(const GridDemands& demands) {
    return std::max(kLeastPenumbra, demands.shadow_error);
}

/// The fewest rays along an edge for penumbrae of these widths, in pixels: 1, 2, or 2^n + 1.
int rays_for(std::vector<double>& widths, double step, int most) {
    if (widths.empty())
        return 1;
    const auto wider = static_cast<size_t>(kSteppedShare * static_cast<double>(widths.size()));
    std::nth_element(widths.begin(), widths.begin() + static_cast<ptrdiff_t>(wider), widths.end(),
                     std::greater<>());
    const double steps = widths[wider] / step;
    if (!(steps > 1))
        return 1;
    const double few = std::max(2.0, steps / kPenumbraeOfRay);
    return grid_rays(std::min(few, std::max(kFewRays, steps / kPenumbraeOfManyRays)), most);
}

}  // namespace

int finest_sun_rays(const Light& sun, int rays) {
    if (rays <= 1 || !sun.shadow || !(sun.angle > 0))
        return 1;
    const int most = sun.angle / 2 < kNarrowSun ? (kNarrowRays - 1) * (rays - 1) / 16 : rays - 1;
    return std::max(most, 2) + 1;
}

double sun_shadow_rays(int rays) {
    const double all = static_cast<double>(rays) * rays;
    return all <= kCorners ? all : kCorners + kRefinedSun * (all - kCorners);
}

std::vector<uint32_t> soft_suns(std::span<const Light> lights, const View& view,
                                const GridDemands& demands, std::span<const Bound> bounds) {
    std::vector<uint32_t> out;
    for (uint32_t i = 0; i < lights.size(); ++i) {
        if (shines_as_sun(lights[i]) && finest_sun_rays(lights[i], demands.rays) > 1 &&
            widest_penumbra(lights[i], view, bounds) > narrowest(demands))
            out.push_back(i);
    }
    return out;
}

int fit_sun_rays(const LitScene& scene, std::span<const LitPoint> points, const Light& sun,
                 const View& view, const GridDemands& demands, const Job& job) {
    const double across = 2 * std::tan(std::min(sun.angle / 2, 1.5));
    std::vector<double> widths(points.size());
    parallel_for((points.size() + kPointStrip - 1) / kPointStrip, [&](size_t strip) {
        job.check();
        const size_t end = std::min(points.size(), (strip + 1) * kPointStrip);
        for (size_t i = strip * kPointStrip; i < end; ++i) {
            const double z = glm::length(points[i].position - view.camera.position);
            widths[i] = scene.penumbra_from(sun, points[i]) * across /
                        std::max(choose::pixel_size(view, z), 1e-300);
        }
    });
    return rays_for(widths, narrowest(demands), finest_sun_rays(sun, demands.rays));
}

}  // namespace lodestone::light
