// SPDX-License-Identifier: GPL-3.0-or-later
// Guards by how many rays suns are sampled: as many as the penumbrae of a view need.
#include "base/parallel.h"
#include "light/sun_plan.h"
#include "scenes/small_models.h"
#include "scenes/with_rays.h"

#include <array>
#include <limits>

using namespace lodestone;
using namespace lodestone::light;
using models::add_leaf;
using models::moved;

namespace {

/// From above, 128 x 72 pixels of 0.1 m.
View from_above() {
    View view;
    view.width = 128;
    view.height = 72;
    view.camera.orthographic = true;
    view.camera.position = {0, 0, 100};
    view.camera.direction = {0, 0, -1};
    view.camera.right = {12.8, 0, 0};
    view.camera.up = {0, 7.2, 0};
    view.pixel_error = 1;
    return view;
}

/// A sun in the zenith that looks 0.02 m wide from 1 m.
Light zenith() {
    Light sun;
    sun.kind = LightKind::Sun;
    sun.direction = {0, 0, -1};
    sun.angle = 0.02;
    return sun;
}

LightDemands demands() {
    LightDemands out;
    out.grids.shadow_error = 1;
    out.measured_suns = true;
    return out;
}

class SunPlanTest : public WithRays {
protected:
    SunPlanTest() { model_.lights = {zenith()}; }

    /// A rectangle of matt stuff around a point, facing up.
    void add(const glm::dvec3& middle, double width, double depth, const Material& material = {}) {
        const Mesh mesh = shapes::quad(static_cast<float>(width), static_cast<float>(depth));
        const std::string uid = "thing " + std::to_string(model_.objects.size());
        things_.emplace_back(add_leaf(model_, uid, mesh, material),
                             moved(middle.x - width / 2, middle.y - depth / 2, middle.z));
    }
    LightPlan plan(const LightDemands& wanted = demands()) const {
        RendererSurfaces renderer;
        renderer.reflections.resize(model_.materials.size());
        std::vector<DrawnThing> drawn;
        for (const auto& [thing, place] : things_)
            drawn.push_back({&model_.objects[thing].representations[0], place, 0});
        Problems problems;
        LightPlan out = plan_lights(model_, renderer, drawn, from_above(), wanted, problems);
        EXPECT_TRUE(problems.empty());
        return out;
    }
    /// The rays along an edge of the only sun; 0: it is not planned.
    int rays(const LightDemands& wanted = demands()) const {
        const LightPlan found = plan(wanted);
        EXPECT_TRUE(found.empty());
        return found.suns.size() == 1 ? found.suns[0].rays : 0;
    }

    Model model_;
    std::vector<std::pair<ObjectIndex, Affine>> things_;
};

}  // namespace

TEST_F(SunPlanTest, WhereNothingIsNoSunIsPlanned) {
    EXPECT_EQ(rays(), 0);
    add({0, 0, 0}, 20, 20);
    EXPECT_EQ(rays(), 0);  // flat ground: no penumbra can be
    add({0, 0, 30}, 20, 1);
    EXPECT_EQ(rays(), 2);
    LightDemands sharp = demands();
    sharp.grids.rays = 1;
    EXPECT_EQ(rays(sharp), 0);
    sharp = demands();
    sharp.measured_suns = false;
    EXPECT_EQ(rays(sharp), 0);
    model_.lights[0].angle = 0;
    EXPECT_EQ(rays(), 0);
}

TEST_F(SunPlanTest, APenumbraHasARayForThreePixelsAndAWideOneForSix) {
    // The height of a bar, whose penumbra is 0.2 pixels wide for each metre, and the rays, where it
    // shows from a pixel on and from half a pixel on.
    const std::array<int, 3> known[] = {{9, 2, 2}, {24, 2, 3}, {40, 3, 3}, {60, 3, 5}, {80, 3, 9}};
    LightDemands fine = demands();
    fine.grids.shadow_error = 0.5;
    for (const auto& [height, expected, finer] : known) {
        things_.clear();
        add({0, 0, 0}, 20, 20);
        add({0, 0, static_cast<double>(height)}, 20, 1);
        EXPECT_EQ(rays(), expected) << height;
        EXPECT_EQ(rays(fine), finer) << height;
    }
}

// A real sun's shadows of leaves were cast by up to 25 rays from each point of a garden.
TEST_F(SunPlanTest, LeavesNearTheGroundHaveSharpShadowsBelowATower) {
    add({0, 0, 0}, 20, 20);
    for (int i = 0; i < 12; ++i)
        add({i - 6.0, 0.3 * i - 2, 0.5}, 0.4, 0.4);
    add({100, 100, 80}, 1, 1);  // makes the widest penumbra that could be wide
    EXPECT_EQ(rays(), 1);
}

TEST_F(SunPlanTest, WhatHidesLessThanHalfOfTheSunHasNoPenumbra) {
    Material film;
    film.alpha_mode = AlphaMode::Blend;
    film.alpha = 0.3;
    add({0, 0, 0}, 20, 20);
    add({0, 0, 40}, 20, 1, film);
    EXPECT_EQ(rays(), 1);
    model_.materials.back().alpha = 0.7;
    EXPECT_EQ(rays(), 3);
}

TEST_F(SunPlanTest, WideShadowsOnHardlyAnythingChangeNothing) {
    add({0, 0, 0}, 20, 20);
    add({5, 0, 41}, 0.1, 0.1);
    EXPECT_EQ(rays(), 1);
    add({0, 0, 41}, 0.5, 7.2);
    EXPECT_EQ(rays(), 3);
}

TEST_F(SunPlanTest, ThreadsChangeNothing) {
    add({0, 0, 0}, 20, 20);
    for (int i = 0; i < 8; ++i)
        add({1.5 * i - 6, 0.5 * i - 2, 5.0 + 4 * i}, 1, 1);
    const LightPlan many = plan();
    const ThreadLimit one(1);
    const LightPlan single = plan();
    EXPECT_EQ(many.suns, single.suns);
}

TEST_F(SunPlanTest, SunsThatAreNoNumbersStayAsTheyAre) {
    add({0, 0, 0}, 20, 20);
    add({0, 0, 40}, 20, 1);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    model_.lights.assign(4, zenith());
    model_.lights[0].angle = nan;
    model_.lights[1].direction = glm::dvec3(0.0);
    model_.lights[2].power = -1;
    ASSERT_EQ(plan().suns.size(), 1u);
    EXPECT_EQ(plan().suns[0].light, 3u);
}
