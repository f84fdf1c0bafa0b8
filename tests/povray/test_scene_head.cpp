// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the beginning of a scene: as many surfaces one behind the other as show.
#include "povray_export/scene/scene_head.h"
#include "scenes/small_models.h"

#include <gtest/gtest.h>
#include <limits>
#include <memory>

using namespace lodestone;
using namespace lodestone::povray;

namespace {

Material plain() {
    return models::colored("plain", glm::dvec3(0.8), 1);
}
Material polished(double specular) {
    Material out = models::colored("polished", glm::dvec3(0.8), 0);
    out.specular = specular;
    return out;
}
Material metal() {
    Material out = polished(0.5);
    out.metallic = 1;
    return out;
}
Material glass() {
    Material out = polished(0.5);
    out.transmission = 1;
    return out;
}
Material clear(Material material) {
    material.alpha_mode = AlphaMode::Blend;
    return material;
}

/// The max_trace_level that is written for a scene of these materials.
int levels(const std::vector<Material>& materials, int trace_depth = 5, double error = 1,
           int bounces = 0) {
    Shading shading;
    shading.trace_depth = trace_depth;
    shading.reflection_error = error;
    shading.bounces = bounces;
    SceneHead head;
    for (const Material& material : materials)
        add_onward(material, head.onward);
    const std::string text = head_text(head, filled_up(shading, Antialiasing::Final, 1), {});
    const std::string word = "max_trace_level ";
    return std::stoi(text.substr(text.find(word) + word.size()));
}

}  // namespace

// A race track of polished tires took twice as long as what its picture shows.
TEST(SceneHead, MirroredRaysEndWhereTheNextOneShowsNothing) {
    EXPECT_EQ(levels({}), 1);
    EXPECT_EQ(levels({plain()}), 1);
    EXPECT_EQ(levels({plain(), polished(0.1)}), 2);
    EXPECT_EQ(levels({plain(), polished(0.5)}), 3);
    EXPECT_EQ(levels({polished(1)}), 3);
    EXPECT_EQ(levels({polished(1)}, 5, 8), 2);
    EXPECT_EQ(levels({metal()}), 5);
    EXPECT_EQ(levels({metal()}, 7), 7);
    EXPECT_EQ(levels({metal()}, 2), 2);
}

TEST(SceneHead, WhatRaysGoOnThroughNeedsTheirLevelOnceMore) {
    EXPECT_EQ(levels({clear(plain())}), 2);
    EXPECT_EQ(levels({clear(plain()), polished(1)}), 4);
    EXPECT_EQ(levels({clear(metal())}), 5);
    EXPECT_EQ(levels({glass()}), 10);
    Material straight = glass();
    straight.ior = std::numeric_limits<double>::infinity();
    straight.roughness = 1;
    EXPECT_EQ(levels({straight}), 2);
    EXPECT_EQ(levels({plain()}, 5, 1, 2), 5);  // light between surfaces is found by rays, too
}

TEST(SceneHead, TheMostThatAMixtureOrAPictureMayMirrorCounts) {
    Material mixed = plain();
    mixed.other = std::make_shared<Material>(metal());
    EXPECT_EQ(levels({mixed}), 5);
    Material pictured = plain();
    pictured.metallic_texture.picture = std::make_shared<Picture>();
    pictured.roughness_texture.picture = std::make_shared<Picture>();
    EXPECT_EQ(levels({pictured}), 5);
    Material none = polished(std::numeric_limits<double>::quiet_NaN());
    none.base_color = glm::dvec3(std::numeric_limits<double>::quiet_NaN());
    const int written = levels({none});
    EXPECT_GE(written, 1);
    EXPECT_LE(written, 5);
}
