// SPDX-License-Identifier: GPL-3.0-or-later
// Guards gloss seen at grazing angles: it grows as Cycles' does, under a sky and under a sun, on
// every kind of opaque surface, and lets POV-Ray stop shadow rays.
#include "povray/povray_scenes.h"
#include "povray_export/texture/grazing_gloss.h"
#include "povray_export/texture/texture_writer.h"

using namespace lodestone;
using namespace lodestone::povray;
using scenes::checker;

namespace {

constexpr double kFacing = 0.037;  // what Cycles returns at roughness 0.5

Material black(double roughness) {
    Material material;
    material.base_color = glm::dvec3(0.0);
    material.roughness = roughness;
    return material;
}

/// A square that is turned by that angle away from the eye above, and fills the middle.
Affine turned(double degrees) {
    const double angle = degrees / 180 * kPi;
    Affine place;
    place.linear[0] = glm::dvec3(std::cos(angle), 0, -std::sin(angle)) / std::cos(angle);
    place.linear[2] = {std::sin(angle), 0, std::cos(angle)};
    return place;
}

Mesh square_with_uvs() {
    Mesh square = shapes::quad(2, 2);
    for (glm::vec3& at : square.positions) {
        square.uvs.emplace_back(at.x / 2, at.y / 2);
        at -= glm::vec3(1, 1, 0);
    }
    return square;
}

/// The radiance of a material's middle, as seen at an angle.
double seen(const Material& material, double degrees, double sky, std::optional<Light> sun = {}) {
    scenes::Builder builder;
    builder.model.world.color = glm::dvec3(sky);
    if (sun)
        builder.model.lights.push_back(*sun);
    builder.place(builder.mesh(square_with_uvs(), {builder.material(material)}), turned(degrees));
    ExportOptions options;
    options.folder = own_scratch() / "gloss";
    options.antialiasing = Antialiasing::Off;
    return scenes::render(builder.finish(), scenes::above(16, 16), options).at(8, 8).y;
}

}  // namespace

TEST(GrazingGloss, SurfacesWithoutARoughWhiteReflectionHaveNone) {
    Material material = black(0.5);
    EXPECT_TRUE(grazing_gloss(look_of(material)));
    material.specular = 0;
    EXPECT_FALSE(grazing_gloss(look_of(material)));
    material.specular = 0.5;
    material.metallic = 1;
    EXPECT_FALSE(grazing_gloss(look_of(material)));
    EXPECT_FALSE(grazing_gloss(look_of(black(0.1))));  // it mirrors
}

TEST(GrazingGloss, ItGrowsWithTheAngleAndLessWhereTheSurfaceIsRougher) {
    double flattest = 1e9;
    for (double roughness = 0.25; roughness <= 1; roughness += 0.05) {
        const auto gloss = grazing_gloss(look_of(black(roughness)));
        ASSERT_TRUE(gloss) << roughness;
        EXPECT_EQ(gloss->grow[0], 1);
        for (size_t i = 1; i < gloss->grow.size(); ++i)
            EXPECT_GT(gloss->grow[i], gloss->grow[i - 1]) << roughness;
        EXPECT_LT(gloss->sky * gloss->grow.back(), flattest) << roughness;
        flattest = gloss->sky * gloss->grow.back();
    }
}

// Dark turf of specular 0.1 had four times the highlight of a high sun that Cycles has.
TEST(GrazingGloss, WeakHighlightsGrewAsTheSkysReflectionDoes) {
    const auto highlight = [](double specular, double roughness) {
        Material material = black(roughness);
        material.specular = specular;
        const auto gloss = grazing_gloss(look_of(material));
        return gloss->highlight * (1 + gloss->lamp_growth * (gloss->grow[5] - 1));
    };
    for (const double roughness : {0.3, 0.6, 0.9}) {
        EXPECT_NEAR(highlight(0.1, roughness) / highlight(0.5, roughness), 0.2, 1e-9);
        EXPECT_NEAR(highlight(1, roughness) / highlight(0.5, roughness), 2, 1e-9);
    }
}

TEST(GrazingGloss, StrongAndWeakGlossComeTogetherWhereNothingIsSeenOfTheSurface) {
    // Measured in Cycles at roughness 0.5: specular 0.2 and 1 over 0.5, facing and at 80 degrees.
    const auto at = [](double specular, size_t angle) {
        Material material = black(0.5);
        material.specular = specular;
        const auto gloss = grazing_gloss(look_of(material));
        return gloss->sky * gloss->grow[angle];
    };
    EXPECT_NEAR(at(0.2, 0) / at(0.5, 0), 0.40, 0.01);
    EXPECT_NEAR(at(0.2, 5) / at(0.5, 5), 0.74, 0.04);
    EXPECT_NEAR(at(1, 5) / at(0.5, 5), 1.25, 0.06);
}

TEST(GrazingGloss, AnOpaqueSurfaceStaysOpaqueToPovray) {
    for (const bool picture : {false, true}) {
        Material material = picture ? scenes::textured(checker()) : black(0.5);
        material.specular = 0.5;
        TexturedSurface surface;
        surface.uvs = picture;
        PictureWriter pictures;
        std::string all = texture_text(material, surface, pictures);
        all += pictures.declarations();
        EXPECT_NE(all.find("pigment{aoi "), std::string::npos);
        EXPECT_EQ(all.find("texture_map"), std::string::npos);
        EXPECT_EQ(all.find("texture{uv_mapping"), std::string::npos);
        EXPECT_LT(all.find("#declare LDS_G_"), all.find("#declare LDS_T_"));  // which uses it
    }
}

// Sunlit cobbles were brown where Cycles shows them gray.
TEST(PovrayRenderGloss, ASkyIsReflectedMoreByWhatIsSeenAtAGrazingAngle) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    // Measured in Cycles, roughness 0.5.
    const std::pair<double, double> measured[] = {{0, kFacing}, {50, 0.051}, {60, 0.067},
                                                  {70, 0.095},  {75, 0.114}, {80, 0.137}};
    for (const auto& [angle, value] : measured)
        EXPECT_NEAR(seen(black(0.5), angle, 1), value, 0.003) << angle;
    Texture dark;
    dark.picture = scenes::picture(2, std::vector<glm::vec4>(4, {0, 0, 0, 1}));
    Material pictured = scenes::textured(dark);
    pictured.specular = 0.5;
    pictured.roughness = 0.5;
    EXPECT_NEAR(seen(pictured, 75, 1), 0.114, 0.003);
    Material matte = black(0.5);
    matte.specular = 0;
    EXPECT_NEAR(seen(matte, 75, 1), 0, 0.001);
}

// Grass and sand of a high roughness were too dark far away.
TEST(PovrayRenderGloss, ARoughSurfaceIsBrighterWhereItIsSeenFlat) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    // Measured in Cycles, the answer of the matte part to a sky at 80 degrees, over that of facing.
    const std::pair<double, double> measured[] = {{0.4, 0.977}, {0.9, 1.188}};
    for (const auto& [roughness, value] : measured) {
        Material dark = black(roughness);
        dark.specular = 0.1;
        Material white = dark;
        white.base_color = glm::dvec3(0.6);
        const auto matte = [&](double angle) {
            return seen(white, angle, 1) - seen(dark, angle, 1);
        };
        EXPECT_NEAR(matte(80) / matte(0), value, 0.01) << roughness;
    }
}

TEST(PovrayRenderGloss, ALowSunShinesOnWhatIsSeenAgainstIt) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    // Measured in Cycles, roughness 0.5: the mirrored sun at 45 degrees, and at 75 degrees.
    const auto mirrored = [](double degrees) {
        Light sun = scenes::sun(kPi);
        const double angle = 2 * degrees / 180 * kPi;
        sun.direction = {-std::sin(angle), 0, -std::cos(angle)};
        return seen(black(0.5), degrees, 0, sun);
    };
    const double high = mirrored(45);
    const double low = mirrored(75);
    EXPECT_GT(high, 0.2);
    EXPECT_LT(high, 0.4);
    EXPECT_GT(low, 0.9);  // it is 2.8; pictures end at 1
}
