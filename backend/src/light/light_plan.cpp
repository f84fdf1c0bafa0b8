// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/light_plan.h"

#include "light/light_arrival.h"
#include "light/light_coverage.h"
#include "light/lit_cells.h"
#include "light/lit_points.h"
#include "light/region/bound_lights.h"
#include "light/region/light_regions.h"
#include "light/sun_plan.h"

#include <algorithm>
#include <map>
#include <optional>

namespace lodestone::light {
namespace {

// The points for each pixel.
// Taste: more miss fewer small patches of light, more slowly.
constexpr double kShare = 0.05;
// The most points for each pixel, in pictures that have more than the fewest points of rooms.
// Taste: the looks at small pictures add points where these are too few.
constexpr double kMostShare = 0.125;
// The fewest points that still distinguish a dozen rooms.
// Fitted: by a row of 12 rooms in 96 x 24 pixels (tests/povray/test_radiosity.cpp).
constexpr double kFewRoomPoints = 3000;
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
// The most lamps where none can be chosen by what they light.
// Taste: with more of them, each an area with 81 rays or more, no picture is finished.
constexpr size_t kMostUnchosen = 64;
// The part of the lights of a point for which POV-Ray casts a ray: many points face away from them.
// And the part of all other rays that they may cost: few points lie where shadows are soft.
// Fitted: to the rays of a floor below slats and two lamps, and to the times of night_street,
// night_tree and night_hotel of tests/bench/scenes.
constexpr double kFacing = 0.6;
constexpr double kInSoftEdges = 0.15;  // Fitted: as kFacing
// The same where nothing is planned, to each lamp.
// Fitted: as kFacing.
constexpr double kRaysOfLamp = 1.1;
// The share of the shadow rays to ungrouped lamps that a point may cost at most: POV-Ray remembers
// for each lamp what last hid it, but not for the lamps of groups, whose shadows take up to 2.4
// times as long.
// Fitted: by tests/bench/speed/bench_lights.py, a house, a corridor and a market of 400 lamps each.
constexpr double kWorth = 0.6;

/// The lights of each region, by nodes of the tree.
struct RegionLights {
    const LightTree& tree;
    const LightCut& cut;
    const std::vector<std::vector<LampGrid>>& grids;  // in the order of the cut
};

/// The lamps that matter to any region. `finest`: each with the finest grid that a region needs of
/// it, or of a light that stands for it; else with one ray.
std::vector<GroupLight> mattering_lamps(const RegionLights& regions, bool finest) {
    const LightTree& tree = regions.tree;
    std::vector<std::optional<LampGrid>> grids(tree.nodes.size());
    for (size_t region = 0; region < regions.cut.size(); ++region) {
        for (size_t i = 0; i < regions.cut[region].size(); ++i) {
            const LampGrid& wanted = regions.grids[region][i];
            for (const uint32_t lamp : tree.lamps(regions.cut[region][i])) {
                if (!grids[lamp])
                    grids[lamp].emplace();
                if (!finest || !(extent_of(tree.nodes[lamp].light) > 0))
                    continue;
                grids[lamp]->rays = std::max(grids[lamp]->rays, wanted.rays);
                grids[lamp]->parts = grids[lamp]->parts || wanted.parts;
                grids[lamp]->soft = grids[lamp]->soft || wanted.soft;
            }
        }
    }
    std::vector<GroupLight> out;
    for (uint32_t lamp = 0; lamp < grids.size(); ++lamp) {
        if (grids[lamp])
            out.push_back({lamp, *grids[lamp]});
    }
    return out;
}

double rays_to(const LightTree& tree, const std::vector<GroupLight>& lights) {
    double sum = 0;
    for (const GroupLight& one : lights)
        sum += shadow_rays(tree.nodes[one.light].light, one.grid);
    return sum;
}

/// Numbers the groups of a plan, each list of lights once.
class GroupNumbers {
public:
    explicit GroupNumbers(LightPlan& plan) : plan_(plan) {}

    uint32_t of(std::vector<GroupLight> lights) {
        const auto [at, fresh] =
            known_.try_emplace(std::move(lights), static_cast<uint32_t>(plan_.groups.size()));
        if (fresh)
            plan_.groups.push_back(at->first);
        return at->second;
    }

private:
    LightPlan& plan_;
    std::map<std::vector<GroupLight>, uint32_t> known_;
};

/// Groups the things on which no point lies: of the lamps that matter anywhere they have those that
/// may matter where they are.
void group_by_place(const LightTree& tree, const std::vector<GroupLight>& mattering,
                    std::span<const Bound> bounds, double pixel_error, GroupNumbers& numbers,
                    std::vector<LitPiece>& pieces) {
    std::vector<const Light*> lamps;
    lamps.reserve(mattering.size());
    for (const GroupLight& one : mattering)
        lamps.push_back(&tree.nodes[one.light].light);
    std::vector<uint32_t> things;
    std::vector<uint32_t> group_of(bounds.size(), kNoRegion);
    for (const LitPiece& piece : pieces) {
        if (piece.group == kNoRegion)
            things.push_back(piece.drawn);
    }
    for (const BoundGroup& group : group_by_bounds(lamps, bounds, things, pixel_error)) {
        std::vector<GroupLight> lights;
        for (const uint32_t lamp : group.lamps)
            lights.push_back(mattering[lamp]);
        const uint32_t number = numbers.of(std::move(lights));
        for (const uint32_t thing : group.things)
            group_of[thing] = number;
    }
    for (LitPiece& piece : pieces) {
        if (piece.group == kNoRegion)
            piece.group = group_of[piece.drawn];
    }
}

/// The groups of regions, and of things without region, of lights that are nodes of the tree.
LightPlan grouped_plan(const RegionLights& regions, std::span<const LitPoint> points,
                       const LightRegions& parts, std::span<const Bound> bounds,
                       double pixel_error) {
    LightPlan plan;
    std::vector<std::vector<GroupLight>> lists;
    for (size_t region = 0; region < regions.cut.size(); ++region) {
        std::vector<GroupLight>& list = lists.emplace_back();
        for (size_t i = 0; i < regions.cut[region].size(); ++i)
            list.push_back({regions.cut[region][i], regions.grids[region][i]});
    }
    for (const LitPoint& point : points) {
        plan.lights_each += static_cast<double>(lists[point.region].size());
        plan.shadow_rays += rays_to(regions.tree, lists[point.region]);
    }
    plan.lights_each /= static_cast<double>(points.size());
    plan.shadow_rays /= static_cast<double>(points.size());
    GroupNumbers numbers(plan);
    plan.pieces = parts.pieces;
    for (LitPiece& piece : plan.pieces) {
        if (piece.group != kNoRegion)
            piece.group = numbers.of(lists[piece.group]);
    }
    group_by_place(regions.tree, mattering_lamps(regions, false), bounds, pixel_error, numbers,
                   plan.pieces);
    return plan;
}

/// The same lamps for everything, each as fine as it is needed anywhere.
LightPlan single_plan(const RegionLights& regions, size_t things) {
    LightPlan plan;
    plan.groups.push_back(mattering_lamps(regions, true));
    plan.lights_each = static_cast<double>(plan.groups[0].size());
    plan.shadow_rays = rays_to(regions.tree, plan.groups[0]);
    for (uint32_t i = 0; i < things; ++i)
        plan.pieces.push_back({i, 0, {}});
    return plan;
}

/// Numbers the lights of a plan, which were nodes of the tree.
void number_lights(const LightTree& tree, LightPlan& plan) {
    std::vector<uint32_t> number(tree.nodes.size(), kNoLight);
    for (std::vector<GroupLight>& group : plan.groups) {
        for (GroupLight& one : group) {
            if (number[one.light] == kNoLight) {
                number[one.light] = static_cast<uint32_t>(plan.lights.size());
                plan.lights.push_back(tree.nodes[one.light].light);
            }
            one.light = number[one.light];
        }
    }
}

/// `grouped`: things may be grouped, where that is worth it.
LightPlan plan_of(const RegionLights& regions, std::span<const LitPoint> points,
                  const LightRegions& parts, std::span<const Bound> bounds, double pixel_error,
                  bool grouped) {
    LightPlan plan = single_plan(regions, bounds.size());
    if (grouped) {
        LightPlan groups = grouped_plan(regions, points, parts, bounds, pixel_error);
        if (groups.groups.size() > 1 && groups.shadow_rays < kWorth * plan.shadow_rays)
            plan = std::move(groups);
    }
    number_lights(regions.tree, plan);
    return plan;
}

/// The light of a lamp that nothing hides, where the camera is.
double light_at_camera(const Light& light, const View& view) {
    const double size = extent_of(light);
    const glm::dvec3 way = light.position - view.camera.position;
    const double square = std::max(glm::dot(way, way) + size * size, 1e-12);
    const double power =
        std::abs(light.power) * std::max({light.color.x, light.color.y, light.color.z});
    return power / square;
}

/// The plan where rays cannot tell what lamps light: those that are strongest at the camera light
/// everything, others nothing; empty where all of them can. `why` is the reason, for the user.
LightPlan strongest_plan(std::span<const Light> lights, size_t things, const View& view, int rays,
                         const char* why, Problems& problems) {
    std::vector<std::pair<double, uint32_t>> lamps;  // by falling light, then as they come
    for (uint32_t i = 0; i < lights.size(); ++i) {
        if (is_lamp(lights[i]))
            lamps.emplace_back(-light_at_camera(lights[i], view), i);
    }
    const size_t count = lamps.size();
    if (count <= kMostUnchosen)
        return {};
    std::sort(lamps.begin(), lamps.end());
    problems.push_back(
        {lights[lamps[kMostUnchosen].second].name, Severity::Warning, "lights_left_out",
         text("it and ", count - kMostUnchosen - 1, " more of ", count, " lamps light nothing: ",
              why, ", so that only those that are strongest at the camera are drawn")});
    lamps.resize(kMostUnchosen);
    LightPlan plan;
    plan.groups.emplace_back();
    for (const auto& [light, index] : lamps) {
        const auto number = static_cast<uint32_t>(plan.lights.size());
        plan.lights.push_back(lights[index]);
        plan.groups[0].push_back({number, finest_grid(lights[index], rays)});
        plan.shadow_rays += shadow_rays(lights[index], plan.groups[0].back().grid);
    }
    plan.lights_each = static_cast<double>(kMostUnchosen);
    for (uint32_t i = 0; i < things; ++i)
        plan.pieces.push_back({i, 0, {}});
    return plan;
}

double rays_to_all(std::span<const Light> lights, int rays) {
    double sum = 0;
    for (const Light& light : lights)
        sum += is_lamp(light) ? shadow_rays(light, finest_grid(light, rays)) : 0;
    return sum;
}

/// The plan of lamps, by points that the view shows; others are added to them. `many`: they may be
/// grouped.
LightPlan plan_lamps(const LitScene& scene, LitGrid& grid, std::span<const Light> lights,
                     std::span<const DrawnThing> drawn, std::span<const Bound> bounds,
                     const View& view, const LightDemands& demands, bool many, const Job& job) {
    std::vector<uint8_t> divisible;
    for (uint32_t i = 0; i < drawn.size(); ++i) {
        const RepresentationSummary& summary = drawn[i].representation->summary;
        // POV-Ray forgets flags of rays in clipped unions, and does not split these.
        divisible.push_back(drawn[i].hidden == 0 && !is_copied(summary.kind) &&
                            !scene.partly_clear(i));
    }
    const double pixel_error = demands.grids.pixel_error;
    const size_t even = grid.points.size();
    scene.add_other_light(demands, grid.points, job);
    std::vector<PointSighting> sightings;
    if (many) {
        const std::vector<uint8_t> cells =
            cells_with_lamps(lights, view, grid, demands.sky, pixel_error, job);
        sightings = add_missing_lit_points(scene, view, divisible, cells, grid, job);
    }
    std::vector<LitPoint>& points = grid.points;
    const LightTree tree = make_light_tree(
        lights, [&](const glm::dvec3& from, const glm::dvec3& to) { return scene.clear(from, to); },
        job);
    const Reaches reaches = [&](const Light& light, const LitPoint& point, uint32_t& blocker) {
        return scene.reaches(light, point, blocker);
    };
    scene.add_other_light(demands, std::span(points).subspan(even), job);
    LightShares shares = find_shares(tree, points, reaches, pixel_error, job);
    std::vector<double> weights;
    for (size_t i = 0; i < tree.nodes.size() && tree.nodes[i].leaf(); ++i) {
        const Light& light = tree.nodes[i].light;
        weights.push_back(shadow_rays(light, finest_grid(light, demands.grids.rays)));
    }
    const LightRegions regions = make_light_regions(bounds, divisible, weights, shares,
                                                    spoken_boxes(sightings, points.size()), points);
    lend_lit_points(sightings, regions, points, shares);
    const LightCut cut = cut_lights(tree, points, shares, regions.count, reaches, pixel_error, job);
    GridDemands finely = demands.grids;
    finely.apart = view.width / static_cast<double>(grid.columns);
    const std::vector<std::vector<LampGrid>> grids = fit_lamp_grids(
        tree, cut, points, shares,
        [&](const Light& light, const LitPoint& point) { return scene.soft(light, point); }, view,
        finely, job);
    // Added points look at corners: the mean is that of the evenly spread ones.
    return plan_of({tree, cut, grids}, std::span(points).first(even), regions, bounds, pixel_error,
                   many);
}

}  // namespace

LightPlan plan_lights(const Model& model, const RendererSurfaces& renderer,
                      std::span<const DrawnThing> drawn, const View& view,
                      const LightDemands& demands, Problems& problems, const Job& job) {
    const auto lamps =
        static_cast<size_t>(std::count_if(model.lights.begin(), model.lights.end(), is_lamp));
    const bool many = lamps >= kManyLamps;
    const bool plans_lamps =
        lamps > 0 && rays_to_all(model.lights, demands.grids.rays) >= kFewShadowRays;
    std::vector<Bound> bounds;
    for (const DrawnThing& thing : drawn)
        bounds.push_back(transformed(thing.representation->summary.bound, thing.world));
    std::vector<uint32_t> suns;
    if (demands.measured_suns)
        suns = soft_suns(model.lights, view, demands.grids, bounds);
    if (drawn.empty() || (!plans_lamps && suns.empty()))
        return {};
    const auto strongest = [&](const char* why) {
        return plans_lamps ? strongest_plan(model.lights, drawn.size(), view, demands.grids.rays,
                                            why, problems)
                           : LightPlan{};
    };
    if (!ray::available())
        return strongest("no rays can be cast to find what each of them lights");
    if (lamps > kMostLamps || LitScene::too_large(drawn)) {
        if (lamps > kMostUnchosen)
            return strongest("there are more of them, or of triangles, than can be looked through");
        if (plans_lamps && many)
            problems.push_back({"", Severity::Info, "lights_as_they_are",
                                text("all ", lamps,
                                     " lamps light everything: there are more of them, or of "
                                     "triangles, than can be looked through")});
        return {};
    }
    const LitScene scene(model, renderer, drawn, job);
    const double pixels = static_cast<double>(view.width) * view.height;
    const double wanted =
        std::max(kShare * pixels, std::clamp(kMostShare * pixels, kFewRoomPoints, kRoomPoints));
    const double judged = static_cast<double>(plans_lamps ? lamps : suns.size());
    const double count = std::clamp(std::min(wanted, kRays / judged), kFewestPoints, kMostPoints);
    const int bounces = plans_lamps ? std::clamp(demands.bounces, 0, kMostHanded) : 0;
    LitGrid grid = scene.points(view, static_cast<size_t>(count / (1 + bounces)), bounces, job);
    if (grid.points.empty())
        return {};
    std::vector<PlannedSun> planned;
    planned.reserve(suns.size());
    for (const uint32_t sun : suns)
        planned.push_back(
            {sun, fit_sun_rays(scene, grid.points, model.lights[sun], view, demands.grids, job)});
    LightPlan plan;
    if (plans_lamps)
        plan = plan_lamps(scene, grid, model.lights, drawn, bounds, view, demands, many, job);
    plan.suns = std::move(planned);
    return plan;
}

int LightPlan::sun_rays(uint32_t light) const {
    const auto sun = std::find_if(suns.begin(), suns.end(),
                                  [&](const PlannedSun& one) { return one.light == light; });
    return sun == suns.end() ? 0 : sun->rays;
}

double mean_lamp_rays(const LightPlan& plan, std::span<const Light> lights) {
    const auto lamps = static_cast<double>(std::count_if(lights.begin(), lights.end(), is_lamp));
    return plan.empty()
               ? kRaysOfLamp * lamps
               : kFacing * plan.lights_each + kInSoftEdges * (plan.shadow_rays - plan.lights_each);
}

double mean_sun_rays(const LightPlan& plan, std::span<const Light> lights) {
    double sum = 0;
    for (uint32_t i = 0; i < lights.size(); ++i) {
        if (lights[i].kind == LightKind::Sun)
            sum += sun_shadow_rays(std::max(1, plan.sun_rays(i)));
    }
    return sum;
}

}  // namespace lodestone::light
