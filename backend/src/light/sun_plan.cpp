// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/sun_plan.h"

#include "base/parallel.h"
#include "choose/criterion.h"
#include "light/penumbra.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

namespace lodestone::light {
namespace {

/// The half angle in radians of a sun whose penumbra is a few pixels.
/// Taste: twice the real sun's; a larger value casts fewer rays for more suns.
constexpr double kNarrowSun = 0.009;
/// The rays along an edge of such a sun.
/// Taste: a larger value has smoother shadows of it where something is very near.
constexpr int kNarrowRays = 5;
/// The share of a thing's points that may lie in wider penumbrae than its grid is made for.
/// Taste: a larger value draws more shadows sharp.
constexpr double kWider = 0.01;
/// The points from which on a thing is judged by its own.
/// Taste: with fewer, chance decides; one of them is more than kWider.
constexpr size_t kEnoughPoints = 100;
/// The rays that POV-Ray casts to a grid before it decides whether it needs the others.
/// Law: its corners (adaptive 0).
constexpr double kCorners = 4;
/// The share of the others that it casts.
/// Fitted: a garden of leaves casts 8 of 25 and 5 of 9.
constexpr double kRefinedSun = 0.2;
/// The share of the rays to ungrouped suns that groups may cost.
/// Fitted: in ravenbridge_mansion (tests/bench/peers/bench_real.py) shadows of a sun take 2.3 times
/// as long in a group: POV-Ray remembers less of it there, and asks again for each corner's texture.
constexpr double kWorthSuns = 0.4;

double narrowest(const GridDemands& demands) {
    return std::max(kLeastPenumbra, demands.shadow_error);
}

/// The fewest rays along an edge for penumbrae of these widths, in pixels: 1, 2, or 2^n + 1. They
/// make steps of twice `step` at most, so that no line of equal light is farther off than that.
int rays_for(std::vector<double>& widths, double step, int most) {
    if (widths.empty())
        return 1;
    const auto wider = static_cast<size_t>(kWider * static_cast<double>(widths.size()));
    std::nth_element(widths.begin(), widths.begin() + static_cast<ptrdiff_t>(wider), widths.end(),
                     std::greater<>());
    const double steps = widths[wider] / step;
    return steps > 1 ? grid_rays(std::max(2.0, steps / 2), most) : 1;
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

std::vector<std::vector<int>> fit_sun_rays(const LitScene& scene, std::span<const LitPoint> points,
                                           std::span<const Light> suns, size_t things,
                                           const View& view, const GridDemands& demands,
                                           const Job& job) {
    std::vector<std::vector<int>> out(things, std::vector<int>(suns.size(), 1));
    std::vector<std::vector<uint32_t>> members(things);
    for (uint32_t i = 0; i < points.size(); ++i)
        members.at(points[i].region).push_back(i);
    std::vector<double> widths(points.size());
    for (size_t k = 0; k < suns.size(); ++k) {
        const Light& sun = suns[k];
        const double across = 2 * std::tan(std::min(sun.angle / 2, 1.5));
        parallel_for((points.size() + kPointStrip - 1) / kPointStrip, [&](size_t strip) {
            job.check();
            const size_t end = std::min(points.size(), (strip + 1) * kPointStrip);
            for (size_t i = strip * kPointStrip; i < end; ++i) {
                const double z = glm::length(points[i].position - view.camera.position);
                widths[i] = scene.penumbra_from(sun, points[i]) * across /
                            std::max(choose::pixel_size(view, z), 1e-300);
            }
        });
        const int most = finest_sun_rays(sun, demands.rays);
        std::vector<double> few;
        for (size_t thing = 0; thing < things; ++thing) {
            std::vector<double> own;
            for (const uint32_t i : members[thing])
                own.push_back(widths[i]);
            if (own.size() < kEnoughPoints)
                few.insert(few.end(), own.begin(), own.end());
            else
                out[thing][k] = rays_for(own, narrowest(demands), most);
        }
        const int rest = rays_for(few, narrowest(demands), most);
        for (size_t thing = 0; thing < things; ++thing) {
            if (!members[thing].empty() && members[thing].size() < kEnoughPoints)
                out[thing][k] = rest;
        }
    }
    return out;
}

void add_suns(LightPlan& plan, std::span<const Light> lights, std::span<const uint32_t> suns,
              const std::vector<std::vector<int>>& rays, std::span<const uint32_t> points) {
    const auto first = static_cast<uint32_t>(plan.lights.size());
    for (const uint32_t sun : suns)
        plan.lights.push_back(lights[sun]);
    plan.suns.assign(suns.begin(), suns.end());
    if (plan.groups.empty()) {
        plan.groups.emplace_back();
        for (uint32_t i = 0; i < rays.size(); ++i)
            plan.pieces.push_back({i, 0, {}});
    }
    // All things with the finest grids that any of them needs, against each with its own.
    std::vector<int> finest(suns.size(), 1);
    for (const std::vector<int>& own : rays) {
        for (size_t k = 0; k < suns.size(); ++k)
            finest[k] = std::max(finest[k], own[k]);
    }
    double grouped = 0;
    double together = 0;
    for (const uint32_t thing : points) {
        for (size_t k = 0; k < suns.size(); ++k) {
            grouped += sun_shadow_rays(rays[thing][k]);
            together += sun_shadow_rays(finest[k]);
        }
    }
    const bool worth = grouped < kWorthSuns * together;
    std::map<std::pair<uint32_t, std::vector<int>>, uint32_t> known;
    std::vector<std::vector<GroupLight>> groups;
    for (LitPiece& piece : plan.pieces) {
        const std::vector<int>& own = worth ? rays[piece.drawn] : finest;
        const auto [at, fresh] =
            known.try_emplace({piece.group, own}, static_cast<uint32_t>(groups.size()));
        if (fresh) {
            groups.push_back(plan.groups[piece.group]);
            for (uint32_t k = 0; k < suns.size(); ++k)
                groups.back().push_back({first + k, {own[k], false}});
        }
        piece.group = at->second;
    }
    plan.groups = std::move(groups);
}

}  // namespace lodestone::light
