// SPDX-License-Identifier: GPL-3.0-or-later
// Guards gloss without a layer, where many lamps are chosen: it follows the angle of a lamp and that
// of view, and casts no shadow ray more.
#include "base/files.h"
#include "light/light_plan.h"
#include "povray/povray_scenes.h"
#include "povray_export/lamp/renderer_surfaces.h"
#include "povray_export/texture/lamp_gloss.h"
#include "povray_export/texture/texture_writer.h"

using namespace lodestone;
using namespace lodestone::povray;

namespace {

Material rough(double gray) {
    Material material;
    material.base_color = glm::dvec3(gray);
    material.roughness = 0.7;
    return material;
}

/// A light as many, in a row so long that one does not stand for all.
std::vector<Light> in_parts(const Light& light) {
    const double count = 32;
    std::vector<Light> parts;
    for (double i = 0; i < count; ++i) {
        parts.push_back(light);
        parts.back().color /= count;
        parts.back().position.y += 3 * ((2 * i + 1) / count - 1);
    }
    return parts;
}

/// The radiance of a square, turned away from the eye, of a scene with many weak lamps (each a 400th
/// of a sun, with 700 W), and `other` in parts.
double radiance(const Material& material, double degrees, double sky,
                std::optional<Light> other = {}, size_t lamps = light::kManyLamps,
                double light_error = 1e-6, double power = 700) {
    const double angle = degrees / 180 * kPi;
    Affine place;
    place.linear[0] = glm::dvec3(std::cos(angle), 0, -std::sin(angle)) / std::cos(angle);
    place.linear[2] = {std::sin(angle), 0, std::cos(angle)};
    Mesh square = shapes::quad(2, 2);
    for (glm::vec3& at : square.positions)
        at -= glm::vec3(1, 1, 0);
    scenes::Builder builder;
    builder.model.world.color = glm::dvec3(sky);
    if (other)
        builder.model.lights = in_parts(*other);
    Light lamp;
    lamp.kind = LightKind::Point;
    lamp.power = power;
    for (size_t i = 0; i < lamps; ++i) {
        lamp.position = {0, 10 * static_cast<double>(i), 50};
        builder.model.lights.push_back(lamp);
    }
    builder.place(builder.mesh(std::move(square), {builder.material(material)}), place);
    ExportOptions options;
    options.folder = own_scratch() / "lamps";
    options.antialiasing = Antialiasing::Off;
    options.light_error = light_error;  // a small one: all lamps are chosen
    return scenes::render(builder.finish(), scenes::above(16, 16), options).at(8, 8).y;
}

Light mirrored_sun(double degrees) {
    Light sun = scenes::sun(kPi);
    const double angle = 2 * degrees / 180 * kPi;
    sun.direction = {-std::sin(angle), 0, -std::cos(angle)};
    return sun;
}

}  // namespace

TEST(LampGloss, MetalsCoatsMirrorsAndMatteSurfacesHaveNone) {
    const auto has = [](auto change) {
        Material material = rough(0.1);
        change(material);
        return lamp_gloss(look_of(material)).has_value();
    };
    EXPECT_TRUE(has([](Material&) {}));
    EXPECT_FALSE(has([](Material& m) { m.specular = 0; }));
    EXPECT_FALSE(has([](Material& m) { m.metallic = 0.5; }));
    EXPECT_FALSE(has([](Material& m) { m.clearcoat = 0.5; }));
    EXPECT_FALSE(has([](Material& m) { m.roughness = 0.1; }));
}

TEST(LampGloss, StrongerGlossIsStrongerOverheadThanFlat) {
    const auto strength = [](double specular) {
        Material material = rough(0.1);
        material.specular = specular;
        const LampGloss gloss = *lamp_gloss(look_of(material));
        return std::pair(gloss.highlight * (1 - gloss.fading), gloss.highlight * gloss.fading);
    };
    const auto weak = strength(0.25);
    const auto strong = strength(0.5);
    EXPECT_NEAR(strong.first / weak.first, 2, 1e-9);
    EXPECT_LT(strong.second / weak.second, 1.6);
    EXPECT_GT(strong.second / weak.second, 1);
}

TEST(LampGloss, ItTakesOneTexture) {
    TexturedSurface surface;
    surface.layered = false;
    PictureWriter pictures;
    const std::string text = texture_text(rough(0.1), surface, pictures);
    EXPECT_NE(text.find("aoi color_map"), std::string::npos);
    EXPECT_EQ(text.find("texture{", 1), std::string::npos);
    EXPECT_TRUE(pictures.declarations().empty());
}

// Pavement between lamps was dark where Cycles shows it shine.
TEST(PovrayRenderLampGloss, ALowLampShinesOnWhatIsSeenAgainstIt) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    // Measured in Cycles: 0.06 at 45 degrees, 0.43 at 75; 0.03 at both without such gloss.
    const double high = radiance(rough(0), 45, 0, mirrored_sun(45));
    const double low = radiance(rough(0), 75, 0, mirrored_sun(75));
    EXPECT_GT(high, 0.03);
    EXPECT_LT(high, 0.18);
    EXPECT_GT(low, 0.3);
    EXPECT_LT(low, 0.5);
}

// Lamps were left out of the plan whose gloss then ended at the border of a region.
TEST(PovrayRenderLampGloss, ThePlanJudgesItAsPovrayDrawsIt) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    for (const double degrees : {20.0, 60.0, 75.0}) {
        const double angle = degrees / 180 * kPi;
        Light lamp;
        lamp.kind = LightKind::Point;
        lamp.power = 300;
        lamp.position = {20 * std::sin(2 * angle), 0, 20 * std::cos(2 * angle)};
        light::LitPoint point;  // in the middle of the square of radiance()
        point.normal = {std::sin(angle), 0, std::cos(angle)};
        Model model;
        model.materials = {rough(0.1)};
        const light::SurfaceReflection surface = renderer_surfaces(model).reflections[0];
        point.albedo = surface.albedo;
        point.highlight = surface.highlight;
        double planned = 0;
        for (const Light& part : in_parts(lamp))
            planned += light::sent_radiance(part, point).y;
        EXPECT_NEAR(radiance(model.materials[0], degrees, 0, lamp, 0) / planned, 1, 0.1) << degrees;
    }
}

TEST(PovrayRenderLampGloss, TheSkyIsReflectedAsFewLampsHaveIt) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    for (const double gray : {0.1, 0.3}) {
        for (const double angle : {0.0, 60.0, 80.0}) {
            const double many = radiance(rough(gray), angle, 1);
            const double few = radiance(rough(gray), angle, 1, {}, 0);
            EXPECT_LT(many, few + 0.015) << gray << ' ' << angle;
            EXPECT_GT(many, few - 0.03) << gray << ' ' << angle;
        }
    }
}

namespace {

/// Whether the square of radiance() has a layer of gloss in a scene with so many lamps.
bool layered(size_t lamps, double light_error, const std::optional<Light>& other = {},
             double power = 700) {
    const std::filesystem::path folder = own_scratch() / "lamps";
    std::filesystem::remove_all(folder);
    radiance(rough(0.1), 60, 0, other, lamps, light_error, power);
    for (const auto& file : std::filesystem::directory_iterator(folder / "r")) {
        if (read_file(file.path()).find("}} texture{") != std::string::npos)
            return true;
    }
    return false;
}

}  // namespace

// The road of a sunlit wood was dull because of lanterns whose light nobody saw.
TEST(PovrayRenderLampGloss, LampsThatMatterNowhereLeaveGlossItsLayer) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    EXPECT_TRUE(layered(light::kManyLamps, 1, mirrored_sun(60), 70));
    EXPECT_FALSE(layered(light::kManyLamps, 1e-6, mirrored_sun(60)));
    EXPECT_TRUE(layered(light::kManyLamps - 1, 1e-6));
}
