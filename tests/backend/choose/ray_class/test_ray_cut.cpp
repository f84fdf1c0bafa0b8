// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what classes of rays meet: nothing a picture can tell, nothing that shadows its own
// original.
#include "choose/ray_class/ray_cut.h"
#include "scenes/lens_views.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

using namespace lodestone;
using bent::kBall;
using choose::Cut;
using choose::RayCut;
using choose::RayState;
using models::add_group;
using models::add_leaf;
using models::moved;
using models::view_from;

namespace {

constexpr double kPixel = 1.0 / 640;  // of the distance, metres

/// A level that is a solid.
void add_solid(Model& model, ObjectIndex object, Kind kind, const Primitive& solid, double error) {
    Representation level;
    level.summary.kind = kind;
    level.materials = model.objects[object].representations[0].materials;
    level.payload = solid;
    summarize(level, model);
    level.summary.error = error;
    model.objects[object].representations.push_back(std::move(level));
}

Light lamp(const glm::dvec3& position, double radius = 0) {
    Light light;
    light.kind = LightKind::Point;
    light.power = 100;
    light.position = position;
    light.radius = radius;
    return light;
}

Material rough() {
    return models::colored("rough", {0.5, 0.5, 0.5}, 0.8);
}

/// A ball `height` metres above the ground, 20 m before the eye, under a lamp; its LOD 1 is an
/// ellipsoid.
Model floating(double height = 4, const Mesh& mesh = shapes::sphere(1, 3),
               const Material& material = rough()) {
    Model model;
    const ObjectIndex ball = add_leaf(model, "ball", mesh, material);
    const ObjectIndex ground =
        add_leaf(model, "ground", shapes::box({-30, -30, -1}, {30, 30, 0}), rough());
    add_solid(model, ball, Kind::Ellipsoid, {}, 0.5);
    model.root = add_group(model, "scene",
                           {{ball, moved(0, 0, 1 + height), "ball"}, {ground, {}, "ground"}});
    summarize_assemblies(model, bottom_up(model));
    model.lights = {lamp({0, 0, 30})};
    return model;
}

View view_of(RayMask rays, double distance = 20, double pixel_error = 1) {
    View view = view_from(distance, pixel_error);
    view.camera.position.z = 4;
    view.modifiers.ray_classes = rays;
    return view;
}

RayCut shadow_cut(const Model& model, const View& view) {
    const Cut cut = choose::choose_cut(model, view);
    std::vector<RayCut> rays = choose::choose_rays(model, view, cut, choose::shape_of);
    EXPECT_EQ(rays.size(), 1u);
    EXPECT_EQ(rays.at(0).states.size(), cut.chosen.size());
    return rays.at(0);
}

RayState shadow_of_ball(const Model& model, double distance = 20, double pixel_error = 1) {
    return shadow_cut(model, view_of(kShadowRays, distance, pixel_error)).states.at(0);
}

RayState image_of_ball(const Model& model, double distance = 20) {
    return shadow_cut(model, view_of(kReflectionRays, distance)).states.at(0);
}

/// The same with something that mirrors behind the ball.
Model mirrored(const Mesh& mirror, const Affine& where, Material material = {}) {
    Model model = floating();
    material.metallic = 1;
    material.roughness = 0.05;
    const ObjectIndex pane = add_leaf(model, "mirror", mirror, material);
    Representation& root = model.objects[model.root].representations[0];
    Assembly placed = root.assembly();
    placed.placements.push_back({pane, where, "mirror"});
    root.payload = std::make_shared<const Assembly>(placed);
    summarize_assemblies(model, bottom_up(model));
    return model;
}

Affine wall() {  // a quad of 1 m becomes 16 x 8 m, upright, 6 m behind the ball
    Affine out;
    out.linear = {{16, 0, 0}, {0, 0, 8}, {0, -1, 0}};
    out.offset = {-8, 6, 0.5};
    return out;
}

}  // namespace

TEST(RayCut, NothingIsAskedForByDefault) {
    const Model model = floating();
    const View view = view_of(0);
    const Cut cut = choose::choose_cut(model, view);
    EXPECT_TRUE(choose::choose_rays(model, view, cut, choose::shape_of).empty());
    const choose::ResidentSize resident = choose::resident_size(model, cut, {});
    EXPECT_EQ(resident.triangles, cut.triangles);
    EXPECT_EQ(resident.bytes, cut.bytes);
}

TEST(RayCut, AFloatingBallThrowsTheShadowOfAnEllipsoidInsideIt) {
    const Model model = floating();
    const View view = view_of(kShadowRays);
    const Cut cut = choose::choose_cut(model, view);
    const RayCut rays = shadow_cut(model, view);
    ASSERT_EQ(rays.own.size(), 1u);
    EXPECT_EQ(rays.states, (std::vector<RayState>{RayState::Own, RayState::Need}));
    EXPECT_EQ(rays.own[0].lod, 1u);
    EXPECT_GT(rays.own[0].scale, 0.97);
    EXPECT_LT(rays.own[0].scale, 1);
    EXPECT_LE(rays.own[0].error_px, 1);
    EXPECT_EQ(rays.largest_error_px, rays.own[0].error_px);
    EXPECT_EQ(rays.triangles, cut.triangles - 1280);
    EXPECT_EQ(rays.met, 2u);
    // Both are in memory
    const choose::ResidentSize both = choose::resident_size(model, cut, {rays});
    EXPECT_EQ(both.triangles, cut.triangles);
    EXPECT_EQ(both.bytes, cut.bytes + model.costs.occurrence_bytes + model.costs.primitive_bytes);
}

TEST(RayCut, WhatTouchesSomethingThrowsItsOwnShadow) {
    EXPECT_EQ(shadow_of_ball(floating(0)), RayState::Contact);
    EXPECT_EQ(shadow_of_ball(floating(2 * 20 * kPixel)), RayState::Contact);
    EXPECT_EQ(shadow_of_ball(floating(8 * 20 * kPixel)), RayState::Own);
    EXPECT_EQ(shadow_of_ball(floating(-0.5)), RayState::Contact);
}

TEST(RayCut, WhatMayShadowItselfOrLetLightThroughThrowsItsOwnShadow) {
    Mesh dented = shapes::sphere(1, 3);
    const glm::vec3 where = dented.positions[0];
    for (glm::vec3& position : dented.positions) {
        if (position == where)
            position *= 0.9f;
    }
    EXPECT_EQ(shadow_of_ball(floating(4, dented)), RayState::Shape);
    Material clear = rough();
    clear.transmission = 0.5;
    EXPECT_EQ(shadow_of_ball(floating(4, shapes::sphere(1, 3), clear)), RayState::Shape);
    clear = rough();
    clear.alpha_mode = AlphaMode::Blend;
    clear.alpha = 0.5;
    EXPECT_EQ(shadow_of_ball(floating(4, shapes::sphere(1, 3), clear)), RayState::Shape);
    clear.alpha_mode = AlphaMode::Opaque;  // alpha says nothing then
    EXPECT_EQ(shadow_of_ball(floating(4, shapes::sphere(1, 3), clear)), RayState::Own);
}

TEST(RayCut, NearAndUnderStrictErrorsShadowsAreExact) {
    EXPECT_EQ(shadow_of_ball(floating(), 20, 0), RayState::Need);
    EXPECT_EQ(shadow_of_ball(floating(), 20, 0.1), RayState::Need);
    EXPECT_EQ(shadow_of_ball(floating(), 20, 2), RayState::Own);
}

TEST(RayCut, ASoftShadowMayBeOffByMoreThanASharpOne) {
    Model model = floating(4, shapes::sphere(1, 1));  // the one inside is off by some pixels
    EXPECT_EQ(shadow_of_ball(model), RayState::Need);
    model.lights = {lamp({0, 0, 30}, 4)};
    const RayCut rays = shadow_cut(model, view_of(kShadowRays));
    ASSERT_EQ(rays.states.at(0), RayState::Own);
    EXPECT_TRUE(rays.own[0].soft);
    model.lights.push_back(lamp({1, 0, 30}));  // one sharp shadow is enough
    EXPECT_EQ(shadow_of_ball(model), RayState::Need);
    model.lights.pop_back();
    model.world.environment = models::checker();  // lights from anywhere
    EXPECT_EQ(shadow_of_ball(model), RayState::Need);
}

TEST(RayCut, NoRepresentationIsOfAnyUseWithoutShadows) {
    Model model = floating();
    model.lights.clear();
    EXPECT_EQ(shadow_of_ball(model), RayState::Need);
    model.lights = {lamp({0, 0, 30})};
    model.lights[0].shadow = false;
    EXPECT_EQ(shadow_of_ball(model), RayState::Need);
}

TEST(RayCut, ALampCloseByOrInsideEnlargesErrors) {
    Model model = floating();
    model.lights = {lamp({0, 0, 6.2})};  // 20 cm above the ball
    EXPECT_EQ(shadow_of_ball(model), RayState::Need);
    model.lights = {lamp({0, 0, 5})};
    EXPECT_EQ(shadow_of_ball(model), RayState::Need);
}

TEST(RayCut, DecisionsAndHiddenClassesAreKept) {
    Model model = floating();
    const auto with = [&](const auto& change) {
        Model changed = model;
        Representation& root = changed.objects[changed.root].representations[0];
        Assembly placed = root.assembly();
        change(placed.placements[0]);
        root.payload = std::make_shared<const Assembly>(placed);
        summarize_assemblies(changed, bottom_up(changed));
        return shadow_of_ball(changed);
    };
    EXPECT_EQ(with([](Placement&) {}), RayState::Own);
    EXPECT_EQ(with([](Placement& ball) { ball.coarsest = 0; }), RayState::Need);
    EXPECT_EQ(with([](Placement& ball) { ball.importance = 32; }), RayState::Need);
    EXPECT_EQ(with([](Placement& ball) { ball.hidden = kShadowRays; }), RayState::Off);
    EXPECT_EQ(with([](Placement& ball) { ball.hidden = kCameraRays; }), RayState::Own);
}

TEST(RayCut, OtherCriteriaAndKindsHaveNothingOfTheirOwn) {
    const Model model = floating();
    View view = view_of(kShadowRays);
    view.kinds = mask_of(Kind::Mesh);
    EXPECT_EQ(shadow_cut(model, view).states.at(0), RayState::Need);
    view = view_of(kShadowRays, 20, 1e-6);
    view.modifiers.criterion = DetailCriterion::Feature;
    EXPECT_EQ(shadow_cut(model, view).states.at(0), RayState::Need);
}

TEST(RayCut, AClassWithoutARuleMeetsWhatTheCameraMeets) {
    const Model model = floating();
    int without = 0;
    for (const RayMask rays : kRayClasses) {
        if (rays == kCameraRays || choose::rule_of(rays) != choose::RayRule::None)
            continue;
        ++without;
        const choose::RayCut cut = shadow_cut(model, view_of(rays));
        EXPECT_EQ(cut.states.at(0), RayState::Need);
        EXPECT_TRUE(cut.own.empty());
    }
    EXPECT_GE(without, 1);  // radiosity
    EXPECT_EQ(choose::rule_of(kShadowRays), choose::RayRule::Shadow);
    EXPECT_EQ(choose::rule_of(kReflectionRays), choose::RayRule::Mirror);
}

TEST(RayCut, ALensMakesShadowsFinerToo) {
    const Model model = floating();
    View view = view_of(kShadowRays);
    view.modifiers.lenses = {bent::lens(0, 8, 32)};
    EXPECT_EQ(shadow_cut(model, view).states.at(0), RayState::Need);
}

TEST(RayCut, NoSampledEdgeOfAShadowIsFartherOffThanPixelError) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(-1, 1);
    const Mesh ball = shapes::sphere(1, 4);
    int found = 0;
    for (int round = 0; round < 60; ++round) {
        Model model = floating(3 + 2 * any(random), shapes::sphere(1, 2 + round % 2));
        const glm::dvec3 light(8 * any(random), 8 * any(random), 22 + 8 * any(random));
        model.lights = {lamp(light)};
        const View view = view_of(kShadowRays, 60 + 30 * any(random), 1 + 0.5 * any(random));
        const Cut cut = choose::choose_cut(model, view);
        const RayCut rays = shadow_cut(model, view);
        if (rays.own.empty() || cut.nodes[rays.own[0].node].lod != 0)
            continue;
        ++found;
        const glm::dvec3 center = cut.world(cut.nodes[rays.own[0].node]).offset;
        const auto on_ground = [&](const glm::dvec3& point) {
            return light + (point - light) * (light.z / (light.z - point.z));
        };
        const auto edge = [&](const Mesh& mesh, double scale, const glm::dvec3& along) {
            glm::dvec3 farthest(0.0);
            double most = -1e300;
            for (const glm::vec3& position : mesh.positions) {
                const glm::dvec3 at = on_ground(center + scale * glm::dvec3(position));
                if (glm::dot(at, along) > most) {
                    most = glm::dot(at, along);
                    farthest = at;
                }
            }
            return farthest;
        };
        const Mesh& drawn = model.objects[kBall].representations[0].mesh();
        for (int i = 0; i < 12; ++i) {
            const glm::dvec3 along(std::cos(i * 0.52), std::sin(i * 0.52), 0);
            const glm::dvec3 here = edge(drawn, 1, along);
            const double off =
                std::abs(glm::dot(here - edge(ball, rays.own[0].scale, along), along));
            const double pixel = kPixel * glm::length(here - view.camera.position);
            EXPECT_LE(off, 1.001 * view.pixel_error * pixel) << round;
        }
    }
    EXPECT_GT(found, 10);
}

TEST(RayCut, FinerPixelErrorsNeverGiveCoarserShadows) {
    Model model = floating(4, shapes::sphere(1, 2));
    model.lights = {lamp({0, 0, 30}, 1.5)};
    bool own = false;
    for (int step = 0; step < 31; ++step) {
        const double error = 0.0625 * std::pow(1.25, step);
        const RayCut rays = shadow_cut(model, view_of(kShadowRays, 20, error));
        if (own && choose::choose_cut(model, view_of(0, 20, error)).nodes[1].lod == 0) {
            EXPECT_EQ(rays.states.at(0), RayState::Own) << error;
        }
        own = own || rays.states.at(0) == RayState::Own;
    }
    EXPECT_TRUE(own);
}

TEST(RayCut, WhatThePictureDoesNotShowThrowsShadowsByItsGroup) {
    Model model = bent::pairs(4);
    View view = view_from(20);
    view.camera.direction = {0, -1, 0};  // away from them
    view.camera.right *= -1.0;
    view.modifiers.ray_classes = kShadowRays;
    Light sun;
    sun.direction = {0, 1, 0};  // and their shadows fall behind
    model.lights = {sun};
    for (Material& material : model.materials)
        material = rough();
    const Cut cut = choose::choose_cut(model, view);
    ASSERT_EQ(cut.chosen.size(), 4u);
    const RayCut rays = shadow_cut(model, view);
    EXPECT_EQ(rays.own.size(), 2u);
    for (const choose::RayChoice& own : rays.own)
        EXPECT_TRUE(cut.nodes[own.node].opened);
    EXPECT_EQ(rays.states, std::vector<RayState>(4, RayState::Group));
    EXPECT_EQ(rays.triangles, 24u);
    EXPECT_EQ(rays.met, 2u);
    // Into the picture, where there is something to fall on
    model.lights[0].direction = {0, -1, 0};
    const ObjectIndex ground = add_leaf(model, "ground", shapes::box({-9, -60, -9}, {9, 0, -8}));
    Representation& root = model.objects[model.root].representations[0];
    Assembly placed = root.assembly();
    placed.placements.push_back({ground, {}, "ground"});
    root.payload = std::make_shared<const Assembly>(placed);
    summarize_assemblies(model, bottom_up(model));
    model.materials.back() = rough();
    EXPECT_EQ(shadow_cut(model, view).states.at(0), RayState::Need);
}

TEST(RayCut, WhatOnlyAMirrorShowsIsReplacedForAllRaysTogether) {
    Model model = mirrored(shapes::quad(1, 1), wall());
    Representation& root = model.objects[model.root].representations[0];
    Assembly placed = root.assembly();
    placed.placements.push_back({kBall, moved(0, -23, 5), "behind"});  // of the eye, by 3 m
    root.payload = std::make_shared<const Assembly>(placed);
    summarize_assemblies(model, bottom_up(model));
    model.objects[kBall].representations[1].summary.error = 0.03;
    // A shadow on itself would be seen in the mirror
    EXPECT_EQ(shadow_cut(model, view_of(kShadowRays)).states.at(3), RayState::Need);
    View view = view_of(kShadowRays | kReflectionRays, 20, 1);
    const Cut cut = choose::choose_cut(model, view);
    ASSERT_EQ(cut.chosen.size(), 4u);
    EXPECT_EQ(cut.nodes[cut.chosen[3]].lod, 0u);
    const auto rays = choose::choose_rays(model, view, cut, choose::shape_of);
    ASSERT_EQ(rays.size(), 2u);
    for (const RayCut& own : rays) {
        ASSERT_EQ(own.states.at(3), RayState::Own);
        EXPECT_TRUE(own.own.back().alone);
        EXPECT_EQ(own.own.back().scale, 1);
        EXPECT_LE(own.own.back().error_px, 1);
    }
    // Its original is in memory no more
    const choose::ResidentSize all = choose::resident_size(model, cut, rays);
    EXPECT_EQ(all.triangles, cut.triangles - 1280);
    // Curved one way or another, it may show it as large as the eye would see it
    Model bent = mirrored(shapes::terrain(8), wall());
    bent.objects[kBall].representations[1].summary.error = 0.03;
    bent.objects[bent.root].representations[0].payload = std::make_shared<const Assembly>(placed);
    summarize_assemblies(bent, bottom_up(bent));
    for (const RayCut& own : choose::choose_rays(bent, view, cut, choose::shape_of))
        EXPECT_FALSE(own.states.at(3) == RayState::Own && own.own.back().alone);
}

TEST(RayCut, AMirrorShowsAnEllipsoidAroundTheBall) {
    EXPECT_EQ(image_of_ball(floating()), RayState::Need);  // no mirror, no use
    const Model flat = mirrored(shapes::quad(1, 1), wall());
    EXPECT_EQ(image_of_ball(flat), RayState::Need);  // LOD 1 is off by .5 m
    Model model = flat;
    model.objects[kBall].representations[1].summary.error = 0.03;
    // Directly seen it must not be off by more than .03 m at 20 m; in the mirror it is 32 m away.
    const View view = view_of(kReflectionRays, 20, 0.9);
    const RayCut rays = shadow_cut(model, view);
    ASSERT_EQ(rays.own.size(), 1u);
    EXPECT_GE(rays.own[0].scale, 1);
    EXPECT_EQ(choose::choose_cut(model, view).nodes[1].lod, 0u);
    // The mirror shows itself as it is
    EXPECT_EQ(rays.states.at(2), RayState::Need);
}

TEST(RayCut, AMirrorOfUnknownCurvatureEnlargesAsSeenDirectly) {
    const auto state = [&](const Mesh& mesh, const Affine& where, const Material& material = {}) {
        Model model = mirrored(mesh, where, material);
        model.objects[kBall].representations[1].summary.error = 0.03;
        return shadow_cut(model, view_of(kReflectionRays, 20, 0.9)).states.at(0);
    };
    EXPECT_EQ(state(shapes::quad(1, 1), wall()), RayState::Own);
    Affine large;
    large.linear = glm::dmat3(3.0);
    large.offset = {0, 10, 4};
    EXPECT_EQ(state(shapes::sphere(1, 3), large), RayState::Own);
    Mesh bowl = shapes::sphere(1, 3);
    for (Triangle& t : bowl.triangles)
        std::swap(t.x, t.y);
    EXPECT_EQ(state(bowl, large), RayState::Need);
    EXPECT_EQ(state(shapes::terrain(8), wall()), RayState::Need);
    Material bumps;
    bumps.bump_texture.picture = models::checker();
    bumps.bump_distance = 0.01;
    EXPECT_EQ(state(shapes::quad(1, 1), wall(), bumps), RayState::Need);
}

TEST(RayCut, WhatMirrorsIsMirroredAsItIs) {
    Model model = mirrored(shapes::quad(1, 1), wall());
    model.objects[kBall].representations[1].summary.error = 0.03;
    model.materials[0].roughness =
        0.1;  // its coat shows the ground, and would show what is around it
    EXPECT_EQ(shadow_cut(model, view_of(kReflectionRays, 20, 0.9)).states.at(0), RayState::Shape);
}

TEST(RayCut, NonsenseIsTheCamerasOrRefused) {
    Model model = floating();
    View view = view_of(kShadowRays | kReflectionRays);
    view.camera.position = {0, 0, 5};  // inside the ball
    const Cut cut = choose::choose_cut(model, view);
    for (const RayCut& rays : choose::choose_rays(model, view, cut, choose::shape_of))
        EXPECT_TRUE(rays.own.empty());
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    for (const glm::dvec3& nowhere : {glm::dvec3(kNan), glm::dvec3(1e300), glm::dvec3(0.0)}) {
        Model broken = model;
        broken.lights = {lamp(nowhere, kNan)};
        broken.lights.push_back(lamp({0, 0, 30}));
        broken.lights[1].kind = LightKind::Sun;
        broken.lights[1].direction = nowhere;
        const RayCut rays = shadow_cut(broken, view_of(kShadowRays));
        EXPECT_EQ(rays.states.size(), 2u);
    }
    view = view_of(kShadowRays);
    view.camera.right *= -1.0;  // mirrored
    EXPECT_EQ(shadow_cut(model, view).states.at(0), RayState::Own);
    Model empty;
    empty.root = add_group(empty, "nothing", {});
    EXPECT_TRUE(shadow_cut(empty, view).own.empty());
}
