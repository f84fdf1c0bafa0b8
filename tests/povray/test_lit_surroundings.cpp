// SPDX-License-Identifier: GPL-3.0-or-later
// Guards that gloss and rough metal show the lit surfaces around them.
#include "povray/povray_scenes.h"
#include "povray_export/lamp/lit_surroundings.h"
#include "povray_export/lamp/renderer_surfaces.h"
#include "povray_export/texture/lamp_gloss.h"
#include "povray_export/texture/texture_writer.h"
#include "scenes/with_rays.h"

using namespace lodestone;
using namespace lodestone::povray;

namespace {

Material metal(double metallic, double roughness) {
    Material out;
    out.base_color = {0.9, 0.6, 0.3};
    out.metallic = metallic;
    out.roughness = roughness;
    return out;
}

class SurroundingsShown : public WithRays {
protected:
    /// The light around a ball of a material, so many pixels across, and around others of it.
    std::vector<light::LightAround> light(const Material& material, double pixels, int copies = 1,
                                          double sky = 0, int bounces = 0, bool still = true) {
        scenes::Builder builder;
        builder.model.lights.push_back(scenes::sun(kPi));
        const ObjectIndex floor = builder.mesh(shapes::quad(200, 200));
        const ObjectIndex ball = builder.mesh(shapes::sphere(1, 4), {builder.material(material)});
        const Model& model = builder.finish();
        std::vector<light::DrawnThing> drawn = {
            {&model.objects[floor].representations[0], {glm::dmat3(1.0), {-100, -100, 0}}}};
        for (int i = 0; i < copies; ++i)
            drawn.push_back({&model.objects[ball].representations[0],
                             {glm::dmat3(1.0), {4.0 * i, 0, 3.0 + 5 * i}}});
        light::LightDemands demands;
        demands.suns = model.lights;
        demands.sky = glm::dvec3(sky);
        demands.bounces = bounces;
        return lit_surroundings(model, renderer_surfaces(model), drawn,
                                things(drawn.size(), pixels), demands, still, {});
    }
    static std::vector<SurroundedThing> things(size_t count, double pixels) {
        return std::vector<SurroundedThing>(count, {pixels, nullptr});
    }
};

}  // namespace

TEST_F(SurroundingsShown, OnlyGlossAndRoughMetalThatAreSeenShowThem) {
    const std::vector<light::LightAround> found = light(metal(1, 0.5), 100);
    EXPECT_EQ(found[0].radiance, glm::dvec3(0.0));  // the floor
    EXPECT_GT(found[1].radiance.x, 0.2);
    EXPECT_EQ(light(metal(1, 0.5), 1)[1].radiance, glm::dvec3(0.0));
    EXPECT_EQ(light(metal(1, 0.1), 100)[1].radiance, glm::dvec3(0.0));  // a mirror
    EXPECT_GT(light(metal(0, 0.5), 100)[1].radiance.x, 0.2);
    Material matt = metal(0, 0.5);
    matt.specular = 0;
    EXPECT_EQ(light(matt, 100)[1].radiance, glm::dvec3(0.0));
    Material mixed = matt;
    mixed.other = std::make_shared<const Material>(metal(1, 0.5));
    EXPECT_GT(light(mixed, 100)[1].radiance.x, 0.2);
}

TEST_F(SurroundingsShown, WhereNothingHidesTheSkyItIsNotCountedTwice) {
    // A floor of albedo 0.8 under a sun of 1 and the sky: 0.8 + 0.8 sky - sky.
    const double alone = light(metal(1, 0.5), 100)[1].radiance.x;
    EXPECT_NEAR(light(metal(1, 0.5), 100, 1, 0.5)[1].radiance.x, alone - 0.1, 0.05);
    EXPECT_EQ(light(metal(1, 0.5), 100, 1, 10)[1].radiance, glm::dvec3(0.0));
}

// With bounces the same light is gathered by POV-Ray.
TEST_F(SurroundingsShown, WhereLightBouncesOnlyRoughMetalShowsThem) {
    EXPECT_EQ(light(metal(0, 0.5), 100, 1, 0, 1)[1].radiance, glm::dvec3(0.0));
    EXPECT_GT(light(metal(1, 0.5), 100, 1, 0, 1)[1].radiance.x, 0.2);
}

// Each frame of an animation wrote anew what stood near something that moved.
TEST_F(SurroundingsShown, InFramesOnlyRoughMetalShowsThem) {
    EXPECT_EQ(light(metal(0, 0.5), 100, 1, 0, 0, false)[1].radiance, glm::dvec3(0.0));
    EXPECT_GT(light(metal(1, 0.5), 100, 1, 0, 0, false)[1].radiance.x, 0.2);
}

// Each light of a copy is a file.
TEST_F(SurroundingsShown, CopiesUnderOneSkyHaveOneLight) {
    const std::vector<light::LightAround> found = light(metal(0, 0.5), 100, 3);
    EXPECT_EQ(found[1].radiance, found[2].radiance);
    EXPECT_EQ(found[1].radiance, found[3].radiance);
    EXPECT_GT(found[1].radiance.x, 0.1);

    scenes::Builder builder;
    builder.model.lights.push_back(scenes::sun(kPi));
    const ObjectIndex floor = builder.mesh(shapes::quad(200, 200));
    const ObjectIndex ball = builder.mesh(shapes::sphere(1, 4), {builder.material(metal(0, 0.5))});
    const Model& model = builder.finish();
    const Representation* const shown = &model.objects[ball].representations[0];
    const std::vector<light::DrawnThing> drawn = {
        {&model.objects[floor].representations[0], {glm::dmat3(1.0), {-100, -100, 0}}},
        {shown, {glm::dmat3(1.0), {0, 0, 3}}},
        {shown, {glm::dmat3(1.0), {0, 0, -3}}}};
    std::vector<SurroundedThing> seen = things(3, 100);
    seen[1].sky = even_sky_light(0.5);
    seen[2].sky = even_sky_light(0.75);
    light::LightDemands demands;
    demands.suns = model.lights;
    const std::vector<light::LightAround> apart =
        lit_surroundings(model, renderer_surfaces(model), drawn, seen, demands, true, {});
    EXPECT_NE(apart[1].radiance, apart[2].radiance);
}

TEST_F(SurroundingsShown, ManyCopiesOfRoughMetalHaveOneLight) {
    const std::vector<light::LightAround> few = light(metal(1, 0.5), 100, 3);
    EXPECT_NE(few[1].radiance, few[3].radiance);
    const std::vector<light::LightAround> many = light(metal(1, 0.5), 100, 8);
    for (size_t i = 2; i < many.size(); ++i)
        EXPECT_EQ(many[i].radiance, many[1].radiance);
    EXPECT_GT(many[1].radiance.x, 0.1);
}

TEST_F(SurroundingsShown, WhereThereIsTooMuchItShowsNothing) {
    scenes::Builder builder;
    builder.model.lights.push_back(scenes::sun(kPi));
    const ObjectIndex floor = builder.mesh(shapes::quad(200, 200));
    const ObjectIndex ball = builder.mesh(shapes::sphere(1, 4), {builder.material(metal(1, 0.5))});
    builder.model.objects[floor].representations[0].summary.cost.triangles = 10'000'000;
    const Model& model = builder.finish();
    const std::vector<light::DrawnThing> drawn = {
        {&model.objects[floor].representations[0], {glm::dmat3(1.0), {-100, -100, 0}}},
        {&model.objects[ball].representations[0], {glm::dmat3(1.0), {0, 0, 3}}}};
    light::LightDemands demands;
    demands.suns = model.lights;
    EXPECT_EQ(lit_surroundings(model, renderer_surfaces(model), drawn, things(2, 100), demands,
                               true, {})[1]
                  .radiance,
              glm::dvec3(0.0));
}

TEST(SurroundingsShownText, WhatIsNotTheSkyIsAround) {
    const light::LightAround around{{1, 2, 3}, 0.5};
    TexturedSurface surface;
    surface.light(1.0, around);  // an open hill
    EXPECT_EQ(surface.around, glm::dvec3(0.0));
    surface.light(0.25, around);
    EXPECT_EQ(surface.sky, 0.25);
    EXPECT_EQ(surface.around, 0.75 * glm::dvec3(1, 2, 3));
    surface.light({}, around);  // no sky was looked for
    EXPECT_EQ(surface.sky, 1);
    EXPECT_EQ(surface.around, 0.5 * glm::dvec3(1, 2, 3));
}

namespace {

std::string text_around(const Material& material, const glm::dvec3& around, bool layered = true) {
    PictureWriter pictures;
    TexturedSurface surface;
    surface.around = around;
    surface.layered = layered;
    const std::string text = texture_text(material, surface, pictures);
    return pictures.declarations() + text;
}

}  // namespace

// Rough metal in a room that lamps light was black but for its highlights.
TEST(SurroundingsShownText, MetalGlowsInItsColorAsMuchAsItSendsOn) {
    const std::string dark = text_around(metal(1, 0.5), glm::dvec3(0.0));
    EXPECT_NE(dark.find("emission rgb <0,0,0>"), std::string::npos) << dark;
    const std::string lit = text_around(metal(1, 0.5), {0.5, 0.5, 1});
    // 0.871 of the light of all sides comes back from metal of that roughness.
    EXPECT_NE(lit.find("emission rgb <0.4355,0.4355,0.871>"), std::string::npos) << lit;
}

// A room with few windows was a tenth darker than in Cycles, the far side of balls in it black.
TEST(SurroundingsShownText, GlossAndTheMattSurfaceBelowGlow) {
    for (const bool layered : {true, false}) {
        const std::string dark = text_around(metal(0, 0.5), glm::dvec3(0.0), layered);
        const std::string lit = text_around(metal(0, 0.5), {0.5, 0.5, 1}, layered);
        EXPECT_NE(lit, dark);
        EXPECT_EQ(lit, text_around(metal(0, 0.5), {0.5, 0.5, 1}, layered));
    }
    Material matt = metal(0, 0.5);
    matt.specular = 0;
    EXPECT_EQ(text_around(matt, {0.5, 0.5, 1}), text_around(matt, glm::dvec3(0.0)));
    // In a texture alone what gloss shows was added once more, as emission.
    const Material paint = metal(0, 0.5);
    Finish finish = finish_of(paint);
    finish.glow = glm::dvec3(carried_by_gloss(paint, 0.6));
    const LampGlossText expected =
        lamp_gloss_text(*lamp_gloss(paint), paint.base_color, finish, {1, glm::dvec3(1.0)});
    const std::string alone = text_around(paint, {1, 1, 1}, false);
    EXPECT_NEAR(std::stod(alone.substr(alone.find("emission rgb <") + 14)), expected.finish.glow.x,
                1e-3 * expected.finish.glow.x);
    // 0.085 of the gray of 0.6, over the 0.735 that the gloss lets through.
    const std::string layers = text_around(metal(0, 0.5), {1, 1, 1});
    EXPECT_NE(layers.find("emission rgb <0.06936,"), std::string::npos) << layers;
}
