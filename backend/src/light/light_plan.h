// SPDX-License-Identifier: GPL-3.0-or-later
// Light plan: the few lights that each object of a scene needs, so that a view looks as with all
// lamps.
#pragma once

#include "base/job.h"
#include "image/decoded_texels.h"
#include "light/lamp_grids.h"
#include "model/model.h"

#include <memory>
#include <optional>
#include <span>

namespace lodestone::light {

/// How much light a material sends back, as the renderer draws it.
struct SurfaceReflection {
    glm::dvec3 albedo{0.8};  // the diffuse share of each color
    SurfaceHighlight highlight;
    bool mirror = false;      // rays go on from it, mirrored or refracted
    bool may_mirror = false;  // somewhere of it: by its pictures, or by what it is mixed with
};

/// The surfaces of a model as its renderer draws them.
struct RendererSurfaces {
    std::vector<SurfaceReflection> reflections;  // one for each material of the model
    double tolerance = 0;  // in metres: things nearer than this cast no shadow on the surface
    /// The masks of the model, decoded once for all who look through them. From any thread.
    std::shared_ptr<image::TexelCache> texels = std::make_shared<image::TexelCache>();
};

/// A placed representation that is drawn.
struct DrawnThing {
    const Representation* representation = nullptr;
    Affine world;
    RayMask hidden = 0;
};

/// The part of a scene that one group of lights lights: a thing, or its part in a box (world
/// frame).
struct LitPiece {
    uint32_t drawn = 0;
    uint32_t group = 0;
    std::optional<Box3> within;
};

/// A light of a group, sampled as finely as the group's points need it.
struct GroupLight {
    uint32_t light = 0;  // index of LightPlan::lights
    LampGrid grid;

    // NOLINTNEXTLINE(modernize-use-nullptr)
    auto operator<=>(const GroupLight&) const = default;
};

/// A sun, and how finely it is sampled.
struct PlannedSun {
    uint32_t light = 0;  // index of the model's lights
    int rays = 1;        // along an edge of its grid; 1: its shadows are sharp

    bool operator==(const PlannedSun&) const = default;
};

struct LightPlan {
    std::vector<Light> lights;  // lamps, and lights that stand for several
    /// A single group lights everything; it needs no group in the renderer.
    std::vector<std::vector<GroupLight>> groups;
    /// In the order of the drawn things; all pieces of a thing together.
    std::vector<LitPiece> pieces;
    double lights_each = 0;  // the mean number of lights of a point that the view shows
    double shadow_rays = 0;  // the mean number of shadow rays that they may cost, to compare plans
    /// The suns that are sampled otherwise than by the widest penumbra that could be. They light
    /// everything.
    std::vector<PlannedSun> suns;

    /// Whether nothing is known of lamps: all of them light everything.
    bool empty() const { return groups.empty(); }
    /// The rays along an edge of a sun, by its number in the model; 0: it is not among `suns`.
    int sun_rays(uint32_t light) const;
};

/// The demands that a plan meets, besides the view.
struct LightDemands {
    GridDemands grids;        // with the Pixel Error of lights
    int bounces = 0;          // how often light goes from surface to surface
    glm::dvec3 sky{0.0};      // radiance of the sky's uniform light
    bool sky_shaded = false;  // true: as far as surfaces see the sky; else all of it everywhere
    std::span<const Light> suns{};  // what else lights the points; lamps among them do not count
    /// True: the model's suns are sampled as finely as the penumbrae need that the view shows.
    bool measured_suns = false;
};

/// With fewer shadow rays to all lamps than this at a point, all of them light everything.
/// Taste: a larger number saves choosing lights where little is to be gained.
inline constexpr double kFewShadowRays = 8;

/// Fewer lamps light everything, if they matter anywhere: no part of a picture can be dark because
/// no point lies on it, and nobody has to look for such parts, which takes most of a plan.
/// Taste: a larger number spares plans, for rays to more lamps at every point.
inline constexpr size_t kManyLamps = 8;

/// Groups drawn things by the lights that light them, each with a grid of rays for that group.
/// POV-Ray shades a group with its own lamps alone, while everything in between casts shadows.
///
/// Rays are cast from lamps to points that the view shows: one in every 20 pixels, at least 12,000
/// (in small pictures one in every 8), in mirrors and behind glass too, and as many more as needed
/// so that every part of a thing that a pixel shows sees one (light_coverage.h). They tell which
/// lamps reach which points, what they are worth in all the light there, and by how much a light
/// that stands for several lamps differs from these (cut_lights). A lamp that reaches no point of
/// an object, nor any beside these, is not among its lights; so a patch of light smaller than the
/// distance of points can be missed. What lamps light here and there (the floor of many rooms, a
/// ground) is cut into boxes. With bounces, points that send light to what the view shows are used,
/// too. A lamp that matters to no point is in no group; things on which no point lies have of the
/// others those that may matter where they are (bound_lights.h).
/// Fewer than 8 lamps are not grouped: those that matter anywhere light everything.
/// Suns have as many rays as the penumbrae need that the view shows.
///
/// Where rays cannot be cast, or there is too much to cast them at, the 64 lamps that are strongest
/// at the camera light everything, and others nothing (a problem).
///
/// Empty if lamps cost few rays, or are few and cannot be chosen; it may have suns all the same.
LightPlan plan_lights(const Model& model, const RendererSurfaces& renderer,
                      std::span<const DrawnThing> drawn, const View& view,
                      const LightDemands& demands, Problems& problems, const Job& job = {});

/// The shadow rays that a renderer casts to the lamps of a plan from a point of the view, in the
/// mean, about: fewer than `shadow_rays`, for from most points all of a lamp is seen, or none of it.
/// Without a plan each lamp counts as sharp.
double mean_lamp_rays(const LightPlan& plan, std::span<const Light> lights);
/// The same to suns; one that is not in the plan counts as sharp.
double mean_sun_rays(const LightPlan& plan, std::span<const Light> lights);

}  // namespace lodestone::light
