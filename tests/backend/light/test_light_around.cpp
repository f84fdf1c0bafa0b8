// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the light that lit surfaces send to things, by answers that are known.
#include "light/light_around.h"
#include "povray/povray_scenes.h"
#include "povray_export/lamp/renderer_surfaces.h"
#include "scenes/with_rays.h"

using namespace lodestone;
using namespace lodestone::light;
using namespace lodestone::povray;

namespace {

/// A ball above a floor of 200 m under a sun that makes white things as bright as 1.
class LitSurroundings : public WithRays {
protected:
    LitSurroundings() {
        builder.model.lights.push_back(scenes::sun(kPi));
        Material white;
        white.base_color = glm::dvec3(0.8);
        white.specular = 0;
        floor = builder.mesh(shapes::quad(200, 200), {builder.material(white)});
        ball = builder.mesh(shapes::sphere(1, 4));
    }

    light::LightAround around_ball(double height, double floor_at = 0) {
        builder.place(floor, {glm::dmat3(1.0), {-100, -100, floor_at}});
        builder.place(ball, {glm::dmat3(1.0), {0, 0, height}});
        const Model& model = builder.finish();
        const auto drawn = [&](ObjectIndex object, const glm::dvec3& at) {
            return DrawnThing{&model.objects[object].representations[0], {glm::dmat3(1.0), at}};
        };
        const std::vector<DrawnThing> things = {drawn(floor, {-100, -100, floor_at}),
                                                drawn(ball, {0, 0, height})};
        LightDemands demands;
        demands.suns = model.lights;
        demands.sky = sky;
        const std::vector<AroundRequest> requests = {{1, 4096}};
        return light_around(model, povray::renderer_surfaces(model), things, requests, demands, {})
            .at(0);
    }

    scenes::Builder builder;
    ObjectIndex floor = 0;
    ObjectIndex ball = 0;
    glm::dvec3 sky{0.0};
};

}  // namespace

TEST_F(LitSurroundings, OfNothingThereIsNone) {
    const Model& model = builder.finish();
    EXPECT_TRUE(light_around(model, povray::renderer_surfaces(model), {}, {}, {}, {}).empty());
}

TEST_F(LitSurroundings, HalfOfABallSeesALitFloor) {
    // A disc of the floor's area, 113 m wide, is seen by a part of (1 - 10 / 113.4) / 2 of all
    // directions; of that its shadow hides one in a hundred.
    const light::LightAround found = around_ball(10);
    EXPECT_NEAR(found.part, 0.456, 0.02);
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(found.radiance[i], 0.8 * 0.99, 0.02);
}

TEST_F(LitSurroundings, AFloorWithItsBackToTheSunIsBlackAndASkyLightsIt) {
    EXPECT_LT(around_ball(-10).radiance[0], 0.02);
    sky = glm::dvec3(0.25, 0.5, 1);
    const light::LightAround found = around_ball(-10);
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(found.radiance[i], 0.8 * sky[i], 0.03 * sky[i] + 0.02);
}

TEST_F(LitSurroundings, LampsCountAsFarAsTheyReach) {
    builder.model.lights.clear();
    Light lamp;
    lamp.kind = LightKind::Point;
    lamp.power = 4 * kPi * kPi * 100;  // white things 10 m away are as bright as 1
    lamp.position = {0, 0, 10};
    builder.model.lights.push_back(lamp);
    const double one = around_ball(3).radiance[0];
    EXPECT_GT(one, 0.05);
    // Two lamps of half of it each.
    builder.model.lights[0].power /= 2;
    builder.model.lights.push_back(builder.model.lights[0]);
    EXPECT_NEAR(around_ball(3).radiance[0], one, 0.03);
    // Behind the floor.
    for (Light& light : builder.model.lights)
        light.position.z = -10;
    EXPECT_LT(around_ball(3).radiance[0], 0.01);
}

TEST_F(LitSurroundings, WithoutSizeThereIsNone) {
    const Affine flat{glm::dmat3(0.0), {0, 0, 5}};
    builder.place(floor, {glm::dmat3(1.0), {-100, -100, 0}});
    const Model& model = builder.finish();
    const std::vector<DrawnThing> things = {
        {&model.objects[floor].representations[0], {glm::dmat3(1.0), {-100, -100, 0}}},
        {&model.objects[ball].representations[0], flat}};
    LightDemands demands;
    demands.suns = model.lights;
    const std::vector<AroundRequest> requests = {{1, 64}};
    EXPECT_EQ(light_around(model, povray::renderer_surfaces(model), things, requests, demands, {})
                  .at(0)
                  .part,
              0);
}
