// SPDX-License-Identifier: GPL-3.0-or-later
// Guards that rough metal shows the lit surfaces around it.
#include "povray/povray_scenes.h"
#include "povray_export/lamp/renderer_surfaces.h"
#include "povray_export/lamp/rough_metal.h"
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

class RoughMetal : public WithRays {
protected:
    /// The light around a ball of a material, so many pixels across, and around others of it.
    std::vector<light::LightAround> light(const Material& material, double pixels, int copies = 1,
                                          double sky = 0) {
        scenes::Builder builder;
        builder.model.lights.push_back(scenes::sun(kPi));
        const ObjectIndex floor = builder.mesh(shapes::quad(200, 200));
        const ObjectIndex ball = builder.mesh(shapes::sphere(1, 8), {builder.material(material)});
        const Model& model = builder.finish();
        std::vector<light::DrawnThing> drawn = {
            {&model.objects[floor].representations[0], {glm::dmat3(1.0), {-100, -100, 0}}}};
        for (int i = 0; i < copies; ++i)
            drawn.push_back({&model.objects[ball].representations[0],
                             {glm::dmat3(1.0), {4.0 * i, 0, 3.0 + 5 * i}}});
        light::LightDemands demands;
        demands.suns = model.lights;
        demands.sky = glm::dvec3(sky);
        return light_on_rough_metal(model, renderer_surfaces(model), drawn,
                                    std::vector<double>(drawn.size(), pixels), demands, {});
    }
};

}  // namespace

TEST_F(RoughMetal, OnlyRoughMetalThatIsSeenShowsWhatIsAroundIt) {
    const std::vector<light::LightAround> found = light(metal(1, 0.5), 100);
    EXPECT_EQ(found[0].radiance, glm::dvec3(0.0));  // the floor
    EXPECT_GT(found[1].radiance.x, 0.2);
    EXPECT_EQ(light(metal(1, 0.5), 1)[1].radiance, glm::dvec3(0.0));
    EXPECT_EQ(light(metal(1, 0.1), 100)[1].radiance, glm::dvec3(0.0));  // a mirror
    EXPECT_EQ(light(metal(0, 0.5), 100)[1].radiance, glm::dvec3(0.0));
    Material mixed = metal(0, 0.5);
    mixed.other = std::make_shared<const Material>(metal(1, 0.5));
    EXPECT_GT(light(mixed, 100)[1].radiance.x, 0.2);
}

TEST_F(RoughMetal, WhereNothingHidesTheSkyItIsNotCountedTwice) {
    // A floor of albedo 0.8 under a sun of 1 and the sky: 0.8 + 0.8 sky - sky.
    const double alone = light(metal(1, 0.5), 100)[1].radiance.x;
    EXPECT_NEAR(light(metal(1, 0.5), 100, 1, 0.5)[1].radiance.x, alone - 0.1, 0.05);
    EXPECT_EQ(light(metal(1, 0.5), 100, 1, 10)[1].radiance, glm::dvec3(0.0));
}

TEST_F(RoughMetal, ManyCopiesHaveOneLight) {
    const std::vector<light::LightAround> few = light(metal(1, 0.5), 100, 3);
    EXPECT_NE(few[1].radiance, few[3].radiance);
    const std::vector<light::LightAround> many = light(metal(1, 0.5), 100, 8);
    for (size_t i = 2; i < many.size(); ++i)
        EXPECT_EQ(many[i].radiance, many[1].radiance);
    EXPECT_GT(many[1].radiance.x, 0.1);
}

TEST_F(RoughMetal, WhereThereIsTooMuchItShowsNothing) {
    scenes::Builder builder;
    builder.model.lights.push_back(scenes::sun(kPi));
    const ObjectIndex floor = builder.mesh(shapes::quad(200, 200));
    const ObjectIndex ball = builder.mesh(shapes::sphere(1, 8), {builder.material(metal(1, 0.5))});
    builder.model.objects[floor].representations[0].summary.cost.triangles = 10'000'000;
    const Model& model = builder.finish();
    const std::vector<light::DrawnThing> drawn = {
        {&model.objects[floor].representations[0], {glm::dmat3(1.0), {-100, -100, 0}}},
        {&model.objects[ball].representations[0], {glm::dmat3(1.0), {0, 0, 3}}}};
    light::LightDemands demands;
    demands.suns = model.lights;
    EXPECT_EQ(light_on_rough_metal(model, renderer_surfaces(model), drawn,
                                   std::vector<double>{100, 100}, demands, {})[1]
                  .radiance,
              glm::dvec3(0.0));
}

TEST(RoughMetalText, WhatIsNotTheSkyIsAround) {
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

// Rough metal in a room that lamps light was black but for its highlights.
TEST(RoughMetalText, ItGlowsInItsColorAsMuchAsMetalSendsOn) {
    const auto text = [](const Material& material, const glm::dvec3& around) {
        PictureWriter pictures;
        TexturedSurface surface;
        surface.around = around;
        return texture_text(material, surface, pictures);
    };
    const std::string dark = text(metal(1, 0.5), glm::dvec3(0.0));
    EXPECT_NE(dark.find("emission rgb <0,0,0>"), std::string::npos) << dark;
    const std::string lit = text(metal(1, 0.5), {0.5, 0.5, 1});
    // 0.871 of the light of all sides comes back from metal of that roughness.
    EXPECT_NE(lit.find("emission rgb <0.4355,0.4355,0.871>"), std::string::npos) << lit;
    EXPECT_EQ(text(metal(0, 0.5), {0.5, 0.5, 1}), text(metal(0, 0.5), glm::dvec3(0.0)));
}
