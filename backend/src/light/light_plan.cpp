// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/light_plan.h"

#include "light/light_arrival.h"
#include "light/light_coverage.h"
#include "light/light_regions.h"
#include "light/lit_points.h"

#include <algorithm>
#include <map>
#include <unordered_set>

namespace lodestone::light {
namespace {

// The points for each pixel.
// Taste: more miss fewer small patches of light, more slowly.
constexpr double kShare = 0.05;
// The most rays, which are points times lamps.
// Taste: more keep the points dense with many lamps, more slowly.
constexpr double kRays = 2e7;
// The fewest points that distinguish a hundred rooms.
// Fitted: by tests/bench/speed/bench_lights.py, a house of 100 rooms and 400 lamps.
constexpr double kRoomPoints = 12000;
// The fewest points with very many lamps.
// Taste: fewer leave most things without a point.
constexpr double kFewestPoints = 256;
// The most points.
// Taste: more take more memory, one share for each lamp and point.
constexpr double kMostPoints = 65536;
// The bounces that are followed.
// Taste: light of later ones is faint, and more bounces take more rays.
constexpr int kMostHanded = 2;
// The most lamps.
// Taste: more take time that no picture is worth.
constexpr size_t kMostLamps = 20000;
// The most distinct triangles.
// Taste: each takes 130 bytes while lights are chosen.
constexpr uint64_t kMostTriangles = 2'000'000;
// The share of all lamps that may light a point at most: POV-Ray remembers for each lamp what last
// hid it, but not for the lamps of groups, whose shadows take up to 2.4 times as long.
// Fitted: by tests/bench/speed/bench_lights.py, a house, a corridor and a market of 400 lamps each.
constexpr double kWorth = 0.6;

uint64_t distinct_triangles(std::span<const DrawnThing> drawn) {
    std::unordered_set<Hash> known;
    uint64_t count = 0;
    for (const DrawnThing& lit : drawn) {
        if (known.insert(lit.representation->summary.hash).second)
            count += lit.representation->summary.cost.triangles;
    }
    return count;
}

LightPlan plan_of(const LightTree& tree, const LightCut& cut, std::span<const LitPoint> points,
                  const LightRegions& regions) {
    std::vector<uint32_t> all;
    for (uint32_t i = 0; i < tree.nodes.size() && tree.nodes[i].leaf(); ++i) {
        if (is_lamp(tree.nodes[i].light))
            all.push_back(i);
    }
    double sum = 0;
    for (const LitPoint& point : points)
        sum += static_cast<double>(cut[point.region].size());
    LightPlan plan;
    plan.lights_each = sum / static_cast<double>(points.size());
    if (!(plan.lights_each < kWorth * static_cast<double>(all.size())))
        return {};
    std::map<std::vector<uint32_t>, uint32_t> known{{all, 0}};
    std::vector<std::vector<uint32_t>> lists{all};
    std::vector<uint32_t> group_of;
    for (const std::vector<uint32_t>& list : cut) {
        const auto [at, fresh] = known.try_emplace(list, static_cast<uint32_t>(lists.size()));
        if (fresh)
            lists.push_back(list);
        group_of.push_back(at->second);
    }
    std::vector<uint32_t> number(tree.nodes.size(), kNoLight);
    for (const std::vector<uint32_t>& list : lists) {
        std::vector<uint32_t>& group = plan.groups.emplace_back();
        for (const uint32_t node : list) {
            if (number[node] == kNoLight) {
                number[node] = static_cast<uint32_t>(plan.lights.size());
                plan.lights.push_back(tree.nodes[node].light);
            }
            group.push_back(number[node]);
        }
    }
    plan.pieces = regions.pieces;
    for (LitPiece& piece : plan.pieces)
        piece.group = piece.group == kNoRegion ? 0 : group_of[piece.group];
    return plan;
}

}  // namespace

LightPlan plan_lights(const Model& model, const RendererSurfaces& renderer,
                      std::span<const DrawnThing> drawn, const View& view, double pixel_error,
                      int bounces, Problems& problems, const Job& job) {
    const auto lamps =
        static_cast<size_t>(std::count_if(model.lights.begin(), model.lights.end(), is_lamp));
    if (!(pixel_error > 0) || lamps < kFewLamps || drawn.empty() || !ray::available())
        return {};
    if (lamps > kMostLamps || distinct_triangles(drawn) > kMostTriangles) {
        problems.push_back({"", Severity::Info, "lights_as_they_are",
                            text("all ", lamps,
                                 " lamps light everything: there are more of them, or of "
                                 "triangles, than can be looked through")});
        return {};
    }
    const LitScene scene(model, renderer, drawn, job);
    const double wanted = std::max(kShare * view.width * view.height, kRoomPoints);
    const double count = std::clamp(std::min(wanted, kRays / static_cast<double>(lamps)),
                                    kFewestPoints, kMostPoints);
    bounces = std::min(bounces, kMostHanded);
    LitGrid grid = scene.points(view, static_cast<size_t>(count / (1 + bounces)), bounces, job);
    std::vector<Bound> bounds;
    std::vector<uint8_t> divisible;
    for (uint32_t i = 0; i < drawn.size(); ++i) {
        const RepresentationSummary& summary = drawn[i].representation->summary;
        bounds.push_back(transformed(summary.bound, drawn[i].world));
        // POV-Ray forgets flags of rays in clipped objects, and unions are not split then.
        divisible.push_back(drawn[i].hidden == 0 && !is_copied(summary.kind) &&
                            !scene.partly_clear(i));
    }
    const size_t even = grid.points.size();
    const std::vector<PointSighting> sightings =
        add_missing_lit_points(scene, view, divisible, grid, job);
    std::vector<LitPoint>& points = grid.points;
    if (points.empty())
        return {};
    const LightTree tree = make_light_tree(
        model.lights,
        [&](const glm::dvec3& from, const glm::dvec3& to) { return scene.clear(from, to); }, job);
    const Reaches reaches = [&](const Light& light, const LitPoint& point, uint32_t& blocker) {
        return scene.reaches(light, point, blocker);
    };
    LightShares shares = find_shares(tree, points, reaches, job);
    const LightRegions regions = make_light_regions(bounds, divisible, shares, points);
    lend_lit_points(sightings, regions, points, shares);
    const LightCut cut = cut_lights(tree, points, shares, regions.count, model.world.color, reaches,
                                    pixel_error, job);
    // Added points look at corners: the mean is that of the evenly spread ones.
    return plan_of(tree, cut, std::span(points).first(even > 0 ? even : points.size()), regions);
}

}  // namespace lodestone::light
