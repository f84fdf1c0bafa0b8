// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the light of the side that is seen: which triangles a picture sees from behind, what their
// light is, and that only a picture alone has it.
#include "light/seen/seen_parts.h"
#include "povray/povray_scenes.h"
#include "povray_export/lamp/seen_sides.h"
#include "povray_export/lamp/sky_occlusion.h"
#include "scenes/fine_grids.h"
#include "scenes/with_rays.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>

using namespace lodestone;
using namespace lodestone::povray;
using scenes::Builder;

namespace {

/// A camera that looks from a place.
Camera from(const glm::dvec3& place) {
    Camera camera;
    camera.position = place;
    camera.direction = -glm::normalize(place);
    return camera;
}

constexpr double kPixels = 10'000;

std::vector<uint8_t> behind(const Mesh& mesh, const Camera& camera, const Affine& world = {},
                            std::span<const uint8_t> seen = {}) {
    SeenSides sides;
    sides.add(mesh, world, camera, kPixels, seen);
    return sides.behind();
}

class SkyInAPictureAlone : public WithRays {
protected:
    SkyInAPictureAlone() { builder.model.world.color = glm::dvec3(0.5); }

    /// The light on each choice of a cut; `camera`: null for a frame.
    std::vector<SkyLightPtr> lights(const Camera* camera, double pixels = 0) {
        const choose::Cut cut = choose::choose_cut(builder.finish(), scenes::above());
        SkyOcclusionOptions options;
        options.camera = camera;
        options.pixels_across = [pixels](const Bound&) { return pixels; };
        Problems problems;
        const SkyOcclusion light(builder.model, cut, options, problems, {});
        EXPECT_TRUE(problems.empty());
        std::vector<SkyLightPtr> out;
        for (size_t i = 0; i < cut.chosen.size(); ++i)
            out.push_back(light.of(i));
        return out;
    }
    static size_t different(const std::vector<SkyLightPtr>& lights) {
        std::vector<Hash> hashes;
        hashes.reserve(lights.size());
        for (const SkyLightPtr& light : lights)
            hashes.push_back(light->hash);
        std::sort(hashes.begin(), hashes.end());
        return static_cast<size_t>(std::unique(hashes.begin(), hashes.end()) - hashes.begin());
    }

    Builder builder;
};

}  // namespace

TEST(SeenSides, OfNothingNothingIsSeenFromBehind) {
    EXPECT_TRUE(SeenSides().behind().empty());
    EXPECT_TRUE(behind({}, from({0, 0, 1})).empty());
}

TEST(SeenSides, ASheetIsSeenFromTheSideOfTheCamera) {
    const Mesh sheet = shapes::quad(1, 1);
    EXPECT_TRUE(behind(sheet, from({0, 0, 3})).empty());
    EXPECT_EQ(behind(sheet, from({0, 0, -3})), std::vector<uint8_t>(2, 1));
    Camera parallel = from({0, 0, 3});
    parallel.orthographic = true;
    EXPECT_TRUE(behind(sheet, parallel).empty());
    parallel.direction = {0, 0, 1};
    EXPECT_EQ(behind(sheet, parallel), std::vector<uint8_t>(2, 1));
}

TEST(SeenSides, APlacementTurnsThem) {
    const Mesh sheet = shapes::quad(1, 1);
    const Affine over{glm::dmat3(glm::rotate(glm::dmat4(1.0), kPi, {1.0, 0.0, 0.0})), {0, 0, 1}};
    EXPECT_EQ(behind(sheet, from({0, 0, 3}), over), std::vector<uint8_t>(2, 1));
    const Affine mirrored{glm::dmat3(-1, 0, 0, 0, 1, 0, 0, 0, 1), {0, 0, 1}};
    EXPECT_TRUE(behind(sheet, from({0, 0, 3}), mirrored).empty());
    const Affine flat{glm::dmat3(0.0), {0, 0, 0}};
    EXPECT_TRUE(behind(sheet, from({0, 0, -3}), flat).empty());
}

TEST(SeenSides, OnlyWhatIsSeenCountsAndOfClosedMeshesNothingElse) {
    const Mesh box = shapes::box({-1, -1, -1}, {1, 1, 1});
    EXPECT_TRUE(behind(box, from({0, 0, 5})).empty());
    const std::vector<uint8_t> all(box.triangles.size(), light::kSeen);
    const std::vector<uint8_t> found = behind(box, from({0, 0, 5}), {}, all);
    EXPECT_EQ(std::count(found.begin(), found.end(), 0), 2);  // its top
    const std::vector<uint8_t> none(box.triangles.size(), 0);
    EXPECT_TRUE(behind(box, from({0, 0, 5}), {}, none).empty());
}

TEST(SeenSides, TheSizeOfWhatIsSeenIsThatOfItsLargestPlacement) {
    const Mesh sheet = shapes::quad(1, 1);  // two triangles
    Camera camera = from({0, 0, 10});
    const auto sizes = [&](std::initializer_list<double> scales) {
        SeenSides sides;
        std::vector<uint8_t> seen = {light::kSeenOfAnySize, 0};
        for (const double scale : scales)
            sides.add(sheet, {glm::dmat3(scale), {}}, camera, kPixels, {});
        EXPECT_EQ(sides.add_sizes(seen), scales.size() > 0);
        EXPECT_EQ(seen[1], 0);
        return seen[0];
    };
    EXPECT_EQ(sizes({}), light::kSeenOfAnySize);
    // The frame is as wide as what is as near as 1 m.
    EXPECT_EQ(sizes({1}), light::size_byte(kPixels / 100 / 2));
    EXPECT_EQ(sizes({1, 2, 0.5}), light::size_byte(4 * kPixels / 100 / 2));
    camera.orthographic = true;
    EXPECT_EQ(sizes({0.1}), light::size_byte(kPixels / 100 / 2));
    EXPECT_EQ(sizes({1e6}), light::size_byte(kPixels));
}

TEST(SeenSides, OfCopiesTheLargestTell) {
    const Mesh sheet = shapes::quad(1, 1);
    const Affine near{glm::dmat3(1.0), {0, 0, 2}};
    const Affine far{glm::dmat3(1.0), {0, 0, -20}};
    SeenSides sides;
    const Camera camera = from({0, 0, 1});
    sides.add(sheet, far, camera, kPixels, {});
    EXPECT_TRUE(sides.behind().empty());
    sides.add(sheet, near, camera, kPixels, {});
    EXPECT_EQ(sides.behind(), std::vector<uint8_t>(2, 1));
}

// The undersides of trees were as light as their tops.
TEST_F(SkyInAPictureAlone, ARoofHasTheLightOfTheSideThatIsSeen) {
    builder.place(builder.mesh(shapes::quad(4, 4)), {glm::dmat3(1.0), {-2, -2, 0.2}});
    builder.place(builder.mesh(shapes::box({-40, -40, -1}, {40, 40, 0})));
    const Camera above = from({0, 0, 10});
    const Camera below = from({0, 0, 0.1});
    const double frame = lights(nullptr)[0]->shares->mean;
    EXPECT_NEAR(frame, 1, 0.01);
    EXPECT_NEAR(lights(&above)[0]->shares->mean, frame, 0.01);
    EXPECT_LT(lights(&below)[0]->shares->mean, 0.15);
}

// The walls of a mine were half as light as the hill above it.
TEST_F(SkyInAPictureAlone, ACaveHasNoLightOfTheHillAboveIt) {
    Mesh cave = shapes::box({-2, -2, -4}, {2, 2, 2});
    for (Triangle& t : cave.triangles)
        std::swap(t.y, t.z);  // its walls face inward
    std::erase_if(cave.triangles, [&](const Triangle& t) {
        return std::max({cave.positions[t.x].z, cave.positions[t.y].z, cave.positions[t.z].z}) < -3;
    });  // of one sheet
    builder.place(builder.mesh(cave));
    builder.place(builder.mesh(shapes::box({-40, -40, -9}, {40, 40, 0})));
    Camera inside = from({0, 0, 1});
    EXPECT_GT(lights(nullptr)[0]->shares->mean, 0.1);
    EXPECT_LT(lights(&inside)[0]->shares->mean, 0.02);
}

// Below a ground only the few places counted from where rays saw the sky through its hole.
TEST_F(SkyInAPictureAlone, WhatIsSeenThroughAHoleInTheGroundIsDark) {
    const ObjectIndex part = builder.mesh(shapes::quad(400, 400));
    const ObjectIndex beside = builder.mesh(shapes::quad(2, 400));
    builder.place(builder.mesh(shapes::quad(8, 8)), {glm::dmat3(1.0), {-4, -4, -2}});
    builder.place(part, {glm::dmat3(1.0), {1, -200, 0}});
    builder.place(part, {glm::dmat3(1.0), {-401, -200, 0}});
    builder.place(beside, {glm::dmat3(1.0), {-1, 1, 0}});
    builder.place(beside, {glm::dmat3(1.0), {-1, -401, 0}});
    const Camera camera = from({0, 0, 0.5});  // sees all of the floor
    const double of_hole = 0.75;              // of the light through it, so much is on the floor
    EXPECT_NEAR(lights(&camera)[0]->shares->mean, of_hole * 2 * 2 / (8 * 8), 0.02);
}

TEST_F(SkyInAPictureAlone, CamerasThatTakeTurnsFindWhatEachOfThemSaw) {
    builder.place(builder.mesh(shapes::quad(4, 4)), {glm::dmat3(1.0), {-2, -2, 0.2}});
    builder.place(builder.mesh(shapes::box({-40, -40, -1}, {40, 40, 0})));
    const choose::Cut cut = choose::choose_cut(builder.finish(), scenes::above());
    SkyOcclusionOptions options;
    options.file = own_scratch() / "sky_light.bin";
    std::filesystem::remove(options.file);
    const auto baked = [&](double height) {
        const Camera camera = from({0, 0, height});
        options.camera = &camera;
        Problems problems;
        return SkyOcclusion(builder.model, cut, options, problems, {}).baked();
    };
    EXPECT_TRUE(baked(10));
    EXPECT_TRUE(baked(0.1));
    EXPECT_FALSE(baked(10));
    EXPECT_FALSE(baked(0.1));
}

TEST_F(SkyInAPictureAlone, TheLargestCopiesHaveTheLightOfWhereTheyStand) {
    const ObjectIndex ball = builder.mesh(shapes::sphere(1, 4));
    for (int x = 0; x < 30; ++x)
        builder.place(ball, {glm::dmat3(1.0), {4.0 * x, 0, 0}});
    builder.place(builder.mesh(shapes::box({-20, -20, 2}, {50, 20, 3})));
    const Camera camera = scenes::above().camera;
    const size_t frame = different(lights(nullptr, 100));
    EXPECT_LE(frame, 5u);
    EXPECT_EQ(different(lights(&camera, 1)), frame);
    const size_t alone = different(lights(&camera, 100));
    EXPECT_GT(alone, frame);  // as many as their triangles may be
    EXPECT_LT(alone, 32u);
}
