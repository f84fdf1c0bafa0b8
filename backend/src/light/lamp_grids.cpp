// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/lamp_grids.h"

#include "base/color.h"
#include "base/parallel.h"
#include "choose/criterion.h"
#include "light/light_arrival.h"
#include "light/penumbra.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace lodestone::light {
namespace {

// The longer over the shorter edge of an area light above which its grid is longer, too.
// Taste: 17 x 5 rays are about as many as 9 x 9.
constexpr double kLong = 3;
// The same, for lights as long as tubes.
// Taste: 33 x 3 rays are about as many as 9 x 9.
constexpr double kVeryLong = 12;
// The rays of a finer grid of a cone or an area that POV-Ray always casts.
// Law: 3 x 3, as such grids are written (adaptive 1).
constexpr double kAlways = 9;
// The same of a point's grid, and where no soft shadow shows.
// Law: its corners, as such grids are written (adaptive 0).
constexpr double kAlwaysCorners = 4;
// The share of the others that it casts.
// Taste: most points see all of a lamp or nothing of it.
constexpr double kRefined = 0.25;

double edge_ratio(const Light& light) {
    if (light.kind != LightKind::Area)
        return 1;
    const double u = glm::length(light.edge_u);
    const double v = glm::length(light.edge_v);
    return std::max(u, v) / std::max(std::min(u, v), 1e-300);
}

/// The steps of an 8-bit display that a light is worth in all the light of a point.
double display_steps(const glm::dvec3& all, const glm::dvec3& part) {
    double steps = 0;
    for (int i = 0; i < 3; ++i) {
        const double with = std::clamp(all[i], 0.0, 1.0);
        const double without = std::clamp(all[i] - part[i], 0.0, 1.0);
        steps = std::max(steps, 255 * (encode_srgb(with) - encode_srgb(without)));
    }
    return steps;
}

/// The most rays along an edge that a point asks for.
/// Taste: far more than any grid has; a larger value changes nothing.
constexpr int kMostRays = 1025;

/// The rays along an edge that a light needs at one kind of difference, over the points of a region.
class GridNeed {
public:
    GridNeed(const Light& light, const IsSoft& soft, const View& view, const GridDemands& demands)
        : light_(light),
          soft_(soft),
          view_(view),
          extent_(extent_of(light)),
          narrowest_(std::max(kLeastPenumbra, demands.shadow_error)),
          step_(std::max(1.0, demands.pixel_error)),
          apart_(demands.apart) {}

    void add(const LitPoint& point, const glm::dvec3& all, const glm::dvec3& part) {
        const double steps = display_steps(all, part) / step_;
        const double pixels = penumbra_at(light_, view_, point.position) / narrowest_;
        // A row of rays too few is half a step off.
        double rays = pixels > 1 ? std::min(std::max(2.0, pixels / kPenumbraeOfRay), steps / 2) : 1;
        // Most points see all of a lamp or nothing of it.
        if (rays > 1 && !soft_(light_, point))
            rays = 1;
        ++points_by_rays_[grid_rays(rays, kMostRays)];
        ++points_;
        // The middles of n parts of a width w at the distance d give the light of all of it to
        // about (w / (n d))^2 / 4 of it.
        const double distance = std::max(glm::length(light_.position - point.position), 1e-9);
        const double z = glm::length(point.position - view_.camera.position);
        const double between = apart_ * choose::pixel_size(view_, z);
        const double nearest = between < 2 * extent_ ? distance - between : distance;
        // So near to a lamp each part of it counts, however much light there is besides.
        if (nearest < extent_ / 2)
            spread_ = std::numeric_limits<double>::infinity();
        else
            spread_ = std::max(spread_,
                               2 * extent_ * distance / (nearest * nearest) * std::sqrt(steps / 2));
    }

    LampGrid grid(int most) const {
        LampGrid out;
        const bool parts = light_.kind != LightKind::Point;
        const int of_penumbrae = rays_of_penumbrae();
        out.rays =
            grid_rays(std::max(static_cast<double>(of_penumbrae), parts ? spread_ : 0.0), most);
        out.soft = of_penumbrae > 1;
        // The edge of a cone is as soft as a shadow's.
        const bool cone = light_.kind == LightKind::Spot || light_.spread > 0;
        out.parts = parts && out.rays > 1 && (cone || spread_ > 1);
        return out;
    }

private:
    /// The rays that all points ask for but a few.
    int rays_of_penumbrae() const {
        auto stepped = static_cast<size_t>(kSteppedShare * static_cast<double>(points_));
        for (auto at = points_by_rays_.rbegin(); at != points_by_rays_.rend(); ++at) {
            if (stepped < at->second)
                return at->first;
            stepped -= at->second;
        }
        return 1;
    }

    const Light& light_;
    const IsSoft& soft_;
    const View& view_;
    double extent_;
    double narrowest_;
    double step_;
    double apart_;
    std::map<int, size_t> points_by_rays_;  // by the rays along an edge that they ask for
    size_t points_ = 0;
    double spread_ = 0;
};

}  // namespace

int grid_rays(double wanted, int most) {
    int rays = 1;
    while (rays < most && rays < wanted)
        rays = rays < 3 ? rays + 1 : 2 * rays - 1;
    return std::min(rays, most);
}

LampGrid finest_grid(const Light& light, int rays) {
    if (!(extent_of(light) > 0) || rays <= 1 || !light.shadow)
        return {};
    if (light.kind == LightKind::Point)
        return {rays, false, true};
    const double ratio = edge_ratio(light);
    if (ratio > kLong)
        return {ratio > kVeryLong ? 2 * rays - 1 : rays, true, true};
    return {std::max(3, (rays - 1) / 2 + 1), true, true};
}

int shorter_edge(const Light& light, int rays) {
    const double ratio = edge_ratio(light);
    const int halved = (rays - 1) / (ratio > kVeryLong ? 16 : ratio > kLong ? 4 : 1) + 1;
    return std::min(rays, std::max(halved, rays > 5 ? 3 : 2));
}

double shadow_rays(const Light& light, const LampGrid& grid) {
    const double all = static_cast<double>(grid.rays) * shorter_edge(light, grid.rays);
    const double always = light.kind == LightKind::Point || !grid.soft ? kAlwaysCorners : kAlways;
    return all <= always ? all : always + kRefined * (all - always);
}

std::vector<std::vector<LampGrid>> fit_lamp_grids(const LightTree& tree, const LightCut& cut,
                                                  std::span<const LitPoint> points,
                                                  const LightShares& shares, const IsSoft& soft,
                                                  const View& view, const GridDemands& demands,
                                                  const Job& job) {
    std::vector<std::vector<uint32_t>> members(cut.size());
    for (size_t i = 0; i < points.size(); ++i)
        members.at(points[i].region).push_back(static_cast<uint32_t>(i));
    std::vector<std::vector<LampGrid>> out(cut.size());
    parallel_for(cut.size(), [&](size_t region) {
        job.check();
        const std::vector<uint32_t>& nodes = cut[region];
        std::vector<GridNeed> needs;
        std::vector<LampGrid> finest;
        for (const uint32_t node : nodes) {
            needs.emplace_back(tree.nodes[node].light, soft, view, demands);
            finest.push_back(finest_grid(tree.nodes[node].light, demands.rays));
        }
        std::vector<glm::dvec3> parts(nodes.size());
        for (const uint32_t index : members[region]) {
            const LitPoint& point = points[index];
            glm::dvec3 all = point.other_light;
            for (size_t i = 0; i < nodes.size(); ++i) {
                parts[i] = sent_radiance(tree.nodes[nodes[i]].light, point);
                double share = 0;
                for (const uint32_t lamp : tree.lamps(nodes[i]))
                    share = std::max(share, static_cast<double>(shares[index][lamp]));
                all += share * parts[i];
            }
            for (size_t i = 0; i < nodes.size(); ++i) {
                if (finest[i].rays > 1 && parts[i].x + parts[i].y + parts[i].z > 0)
                    needs[i].add(point, glm::max(all, parts[i]), parts[i]);
            }
        }
        for (size_t i = 0; i < nodes.size(); ++i)
            out[region].push_back(finest[i].rays > 1 ? needs[i].grid(finest[i].rays) : finest[i]);
    });
    return out;
}

}  // namespace lodestone::light
