// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what hides the sky: it is met alike whether it is joined or stays apart.
#include "light/sky/sky_scene.h"
#include "povray/povray_scenes.h"

using namespace lodestone;
using namespace lodestone::light;
using povray::scenes::Builder;

namespace {

class SkyScenes : public testing::Test {
protected:
    void SetUp() override {
        std::string reason;
        if (!ray::available(&reason))
            GTEST_SKIP() << reason;
    }

    /// What a ray meets first, where all things are joined and where none is.
    std::vector<SkyScene::SkyBlock> blocks(
        const std::vector<std::pair<ObjectIndex, Affine>>& things, const glm::dvec3& from,
        const glm::dvec3& direction) const {
        std::vector<SkyOccluder> occluders;
        std::vector<const Representation*> all;
        for (const auto& [object, world] : things) {
            all.push_back(&builder.model.objects[object].representations[0]);
            occluders.push_back({all.back(), world});
        }
        SkySurfaces surfaces(builder.model);
        surfaces.add(all, {});
        std::vector<SkyScene::SkyBlock> out;
        for (const uint64_t joined : {SkyScene::kMostJoined, uint64_t{0}}) {
            const SkyScene scene(builder.model, surfaces, occluders, {}, joined);
            out.push_back(scene.first_block(from, direction));
            if (out.back().t < kInfinity) {
                EXPECT_EQ(scene.first_block(from, direction, out.back().t - 0.01).t, kInfinity);
                EXPECT_EQ(scene.first_block(from, direction, out.back().t + 0.01).t, out.back().t);
            }
            uint32_t blocker = ray::PlacedScenes::kNothing;
            EXPECT_EQ(scene.hides(from, direction, blocker), out.back().t < kInfinity);
        }
        return out;
    }

    Builder builder;
};

}  // namespace

TEST_F(SkyScenes, NothingHidesNothing) {
    for (const SkyScene::SkyBlock& block : blocks({}, {0, 0, 0}, {0, 0, 1})) {
        EXPECT_EQ(block.t, kInfinity);
        EXPECT_FALSE(block.back);
    }
}

TEST_F(SkyScenes, TheNearestThingIsMet) {
    const ObjectIndex box = builder.mesh(shapes::box({-1, -1, -1}, {1, 1, 1}));
    const std::vector<std::pair<ObjectIndex, Affine>> things = {
        {box, {glm::dmat3(1.0), {0, 0, 5}}}, {box, {glm::dmat3(1.0), {0, 0, 9}}}};
    for (const SkyScene::SkyBlock& block : blocks(things, {0, 0, 0}, {0, 0, 1}))
        EXPECT_NEAR(block.t, 4, 1e-6);
    for (const SkyScene::SkyBlock& block : blocks(things, {0, 0, 0}, {0, 0, -1}))
        EXPECT_EQ(block.t, kInfinity);
}

// Every picture of the model was decoded where one material had a mask.
TEST_F(SkyScenes, PicturesOfWhatIsOpaqueAreNotDecoded) {
    Texture damaged;
    Picture picture;
    picture.width = picture.height = 4;
    picture.bytes = "no picture";
    damaged.picture = std::make_shared<const Picture>(picture);
    Material wall;
    wall.base_color_texture = damaged;
    wall.roughness_texture = damaged;
    Material leaf = wall;
    leaf.alpha_mode = AlphaMode::Clip;
    leaf.alpha = 0.2;
    Mesh card = shapes::quad(4, 4);
    card.uvs.assign(card.positions.size(), glm::vec2(0.5f));
    card.slots = {0, 1};
    const ObjectIndex sheet = builder.mesh(card, {builder.material(wall), builder.material(leaf)});
    for (const SkyScene::SkyBlock& block : blocks({{sheet, {}}}, {3, 1, -1}, {0, 0, 1}))
        EXPECT_NEAR(block.t, 1, 1e-6);
    for (const SkyScene::SkyBlock& block : blocks({{sheet, {}}}, {1, 3, -1}, {0, 0, 1}))
        EXPECT_EQ(block.t, kInfinity);
}

// What stood beside a mirrored thing that was not joined counted as inside of it.
TEST_F(SkyScenes, AMirroredThingHasItsFrontsOutside) {
    const ObjectIndex box = builder.mesh(shapes::box({-1, -1, -1}, {1, 1, 1}));
    for (const double side : {1.0, -1.0}) {
        Affine world;
        world.linear[0].x = side;
        for (const SkyScene::SkyBlock& block : blocks({{box, world}}, {-3, 0, 0}, {1, 0, 0})) {
            EXPECT_NEAR(block.t, 2, 1e-6);
            EXPECT_FALSE(block.back) << side;
        }
        for (const SkyScene::SkyBlock& block : blocks({{box, world}}, {0, 0, 0}, {0.6, 0, 0.8}))
            EXPECT_TRUE(block.back) << side;
    }
}
