// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the text of lights: what POV-Ray gets for each kind, and what is named instead. That their
// energy is Cycles' is tests/blender/blender_test_lights.py's to prove.
#include "povray_export/lamp/light_writer.h"

#include <gtest/gtest.h>
#include <limits>
#include <numbers>

using namespace lodestone;
using namespace lodestone::povray;

namespace {

struct Written {
    std::string text;
    Problems problems;

    bool has(const std::string& part) const { return text.find(part) != std::string::npos; }
};

Written written(const Light& light, const LightSampling& sampling = {}) {
    Written out;
    Bound bound;
    bound.center = {1, 2, 3};
    bound.radius = 10;
    append_light(out.text, light, bound, sampling, out.problems);
    return out;
}

Light light_of(LightKind kind) {
    Light light;
    light.name = "Lamp";
    light.kind = kind;
    light.radius = light.angle = 0.25;
    return light;
}

constexpr LightKind kKinds[] = {LightKind::Sun, LightKind::Point, LightKind::Spot, LightKind::Area};

}  // namespace

TEST(PovrayLight, WithoutPowerNothingIsWritten) {
    for (const LightKind kind : kKinds) {
        Light light = light_of(kind);
        light.power = 0;
        EXPECT_EQ(written(light).text, "");
        EXPECT_TRUE(written(light).problems.empty());
    }
}

TEST(PovrayLight, ASunStartsOutsideOfEverything) {
    Light sun = light_of(LightKind::Sun);
    sun.angle = 0;
    sun.power = std::numbers::pi;
    EXPECT_EQ(written(sun).text, "light_source{<1,2,24> rgb <1,1,1> parallel point_at <1,2,3>}\n");
}

TEST(PovrayLight, HoweverWideASunPointsAreShadedOnceForAllOfIt) {
    for (const double angle : {0.01, 0.2, 0.39, 0.9, 3.0}) {
        Light sun = light_of(LightKind::Sun);
        sun.angle = angle;
        EXPECT_FALSE(written(sun).has("area_illumination")) << angle;
        EXPECT_TRUE(written(sun).has(angle > 0.4 ? " adaptive 1" : " adaptive 0")) << angle;
    }
}

// Boxes beside a floor hid whole rows of rays at once: stripes in wide penumbrae.
TEST(PovrayLight, TheRaysOfASunStandInNoRowAlongTheEdgesOfUprightThings) {
    for (const glm::dvec3& way :
         {glm::dvec3(1, 0, -1), glm::dvec3(0, 2, -1), glm::dvec3(1, 1, -3)}) {
        Light sun = light_of(LightKind::Sun);
        sun.angle = 0.2;
        sun.direction = way;
        const std::string text = written(sun).text;
        const char* at = text.c_str() + text.find("area_light <") + 12;
        glm::dvec3 u;
        ASSERT_EQ(std::sscanf(at, "%lf,%lf,%lf", &u.x, &u.y, &u.z), 3);
        EXPECT_NEAR(glm::dot(u, way), 0, 1e-9 * glm::length(u));
        const glm::dvec3 level = glm::normalize(glm::cross(way, glm::dvec3(0, 0, 1)));
        const double degrees = std::acos(std::abs(glm::dot(level, glm::normalize(u)))) * 180 / kPi;
        EXPECT_GT(degrees, 15);
        EXPECT_LT(degrees, 75);
    }
}

// A third of the rays of a front of windows went to places between others that lit the same.
TEST(PovrayLight, AreasWithoutSoftShadowsBeginWithTheirCorners) {
    Light area = light_of(LightKind::Area);
    area.direction = {0, 0, -1};
    area.edge_u = {1, 0, 0};
    area.edge_v = {0, 1, 0};
    LightSampling sampling;
    sampling.grid = light::LampGrid{9, true, true};
    EXPECT_TRUE(written(area, sampling).has(",9,9 adaptive 1 area_illumination on"));
    sampling.grid->soft = false;
    EXPECT_TRUE(written(area, sampling).has(",9,9 adaptive 0 area_illumination on"));
}

TEST(PovrayLight, OnlySoftLightsCastManyRaysAndDraftsNone) {
    for (const LightKind kind : kKinds) {
        const Light light = light_of(kind);
        EXPECT_TRUE(written(light).has(" area_light ")) << written(light).text;
        const bool in_parts = kind >= LightKind::Spot;
        EXPECT_TRUE(written(light).has(in_parts ? " adaptive 1" : " adaptive 0"));
        const Written finest = written(light, {17, true});
        EXPECT_TRUE(finest.has(in_parts ? " adaptive 2" : " adaptive 1"));
        EXPECT_FALSE(written(light, {1, false}).has("area_light"));
        EXPECT_FALSE(written(light).has("jitter"));
        if (kind == LightKind::Area)
            continue;
        Light sharp = light;
        sharp.radius = sharp.angle = 0;
        EXPECT_FALSE(written(sharp).has("area_light"));
    }
}

TEST(PovrayLight, ASpotFadesFromItsBlendToItsEdge) {
    Light spot = light_of(LightKind::Spot);
    spot.radius = 0;
    spot.spot_size = std::numbers::pi / 2;
    EXPECT_TRUE(written(spot).has("radius 45 falloff 45 tightness 1"));
    spot.spot_blend = 1;
    EXPECT_TRUE(written(spot).has("radius 0 falloff 45 tightness 1"));
    spot.spot_size = std::numbers::pi;
    EXPECT_TRUE(written(spot).has("radius 0 falloff 90 tightness 1"));
}

TEST(PovrayLight, ALongAreaCastsItsRaysAlongItsLength) {
    Light area = light_of(LightKind::Area);
    EXPECT_TRUE(written(area).has(",9,9 adaptive"));
    area.edge_u = {5, 0, 0};
    EXPECT_TRUE(written(area).has(",17,5 adaptive"));
    area.edge_v = {0, 90, 0};
    area.round = true;
    EXPECT_TRUE(written(area).has(",3,33 adaptive 1 circular area_illumination on"))
        << written(area).text;
}

TEST(PovrayLight, FewerStepsOfAPenumbraAreFewerRays) {
    Light area;
    area.kind = LightKind::Area;
    Problems problems;
    const auto text = [&](double steps) {
        std::string out;
        append_light(out, area, {}, {17, false, steps}, problems);
        return out;
    };
    EXPECT_NE(text(1000).find(",9,9 adaptive 1 "), std::string::npos);
    EXPECT_NE(text(5).find(",5,5 adaptive 1 "), std::string::npos);
    EXPECT_NE(text(1).find(",3,3 adaptive 1 "), std::string::npos);
    // As good as a point: one ray, with the same strength.
    const std::string before = text(1000);
    area.edge_u *= 1e-7;
    area.edge_v *= 1e-7;
    EXPECT_EQ(text(1).find("area_light"), std::string::npos);
    EXPECT_NE(text(1).find("spotlight"), std::string::npos);
}

TEST(PovrayLight, ANarrowSpreadIsBrighterAheadAndNamed) {
    Light area = light_of(LightKind::Area);
    EXPECT_TRUE(written(area).has("falloff 90 tightness 1"));
    area.spread = std::numbers::pi / 3;
    const Written narrow = written(area);
    EXPECT_TRUE(narrow.has("radius 0 falloff 30 ")) << narrow.text;
    ASSERT_EQ(narrow.problems.size(), 1u);
    EXPECT_EQ(narrow.problems[0].code, "light_spread");
}

TEST(PovrayLight, NegativePowerTakesLightAway) {
    Light sun = light_of(LightKind::Sun);
    sun.angle = 0;
    sun.power = -2 * std::numbers::pi;
    EXPECT_TRUE(written(sun).has("rgb <-2,-2,-2>"));
}

TEST(PovrayLight, WithoutShadowsAConeKeepsItsShapeAndSaysSo) {
    for (const LightKind kind : kKinds) {
        Light light = light_of(kind);
        light.shadow = false;
        const Written out = written(light);
        const bool cone = kind == LightKind::Spot || kind == LightKind::Area;
        EXPECT_EQ(out.has("shadowless"), !cone) << out.text;
        ASSERT_EQ(out.problems.size(), cone ? 1u : 0u);
        for (const Problem& problem : out.problems)
            EXPECT_EQ(problem.code, "light_shadow");
    }
}

TEST(PovrayLight, WhatIsNotFiniteOrHasNoSizeIsNamedAndLeftOut) {
    Light sun = light_of(LightKind::Sun);
    sun.direction = {0, 0, 0};
    Light point = light_of(LightKind::Point);
    point.position.x = kInfinity;
    Light flat = light_of(LightKind::Area);
    flat.edge_v = flat.edge_u;
    Light broken = light_of(LightKind::Area);
    broken.edge_u.y = kInfinity;
    for (const Light& light : {sun, point, flat, broken}) {
        const Written out = written(light);
        EXPECT_EQ(out.text, "");
        ASSERT_EQ(out.problems.size(), 1u);
        EXPECT_EQ(out.problems[0].object, "Lamp");
    }
}

TEST(PovrayLight, ExtremesGiveTextThatPovrayReads) {
    for (const LightKind kind : kKinds) {
        Light light = light_of(kind);
        for (const double value : {1e-300, 1e-9, 3.14159, 1e9}) {
            light.radius = value;
            light.angle = light.spread = light.spot_size = std::min(value, std::numbers::pi);
            light.edge_u = {value, 0, 0};
            const std::string text = written(light).text;  // throws for inf and nan
            EXPECT_EQ(text.find("nan"), std::string::npos) << text;
            EXPECT_EQ(text.find("inf"), std::string::npos) << text;
        }
    }
}
