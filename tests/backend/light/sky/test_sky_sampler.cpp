// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the rays that look for the sky: from where they go whereto, and what they find of it where
// the answer is known.
#include "light/sky/sky_sampler.h"
#include "povray/povray_scenes.h"

using namespace lodestone;
using namespace lodestone::light;
using povray::scenes::Builder;

namespace {

class SkySampling : public testing::Test {
protected:
    void SetUp() override {
        std::string reason;
        if (!ray::available(&reason))
            GTEST_SKIP() << reason;
    }

    using Things = std::vector<std::pair<Mesh, glm::dvec3>>;

    /// Calls a function with a sampler of the first of the things, and with its mesh.
    template <typename Body>
    void with_sampler(const Things& things, const Body& body) {
        Builder builder;
        std::vector<const Representation*> all;
        for (const auto& [mesh, place] : things)
            builder.mesh(mesh);
        std::vector<SkyOccluder> occluders;
        for (size_t i = 0; i < things.size(); ++i) {
            all.push_back(&builder.model.objects[i + 1].representations[0]);
            occluders.push_back({all.back(), {glm::dmat3(1.0), things[i].second}});
        }
        SkySurfaces surfaces(builder.model);
        surfaces.add(all, {});
        const SkyScene scene(builder.model, surfaces, occluders, {});
        const SkyRequest request{surfaces.of(*all[0]), occluders[0].world, &scene, 0, 256, 0};
        body(SkySampler(request), things[0].first);
    }

    double share_of_first(const Things& things) {
        double share = -1;
        with_sampler(things, [&](const SkySampler& sampler, const Mesh& mesh) {
            share = sampler.shares(mesh, 0, 256).share();
        });
        return share;
    }
};

Mesh upright(float width, float height) {
    Mesh mesh = shapes::quad(width, height);
    for (glm::vec3& position : mesh.positions)
        position = {position.x, 0, position.y};
    return mesh;
}

}  // namespace

TEST_F(SkySampling, ATriangleWithoutAreaHasNoRays) {
    Mesh mesh = shapes::quad(1, 1);
    mesh.positions[1] = mesh.positions[0];
    with_sampler({{mesh, {}}}, [](const SkySampler& sampler, const Mesh& flat) {
        EXPECT_FALSE(sampler.placed(flat, 0));
        EXPECT_EQ(sampler.shares(flat, 0, 64).share(), 0);
        EXPECT_TRUE(sampler.placed(flat, 1));
    });
}

TEST_F(SkySampling, AnOpenPlaneSeesAll) {
    EXPECT_EQ(share_of_first({{shapes::quad(1, 1), {}}}), 1);
}

TEST_F(SkySampling, TheFloorOfADeepWellSeesNothing) {
    const Things well = {{shapes::quad(1, 1), {}},
                         {shapes::box({-1, -1, -1}, {0, 2, 60}), {}},
                         {shapes::box({1, -1, -1}, {2, 2, 60}), {}},
                         {shapes::box({0, -1, -1}, {1, 0, 60}), {}},
                         {shapes::box({0, 1, -1}, {1, 2, 60}), {}}};
    EXPECT_LT(share_of_first(well), 0.01);
}

TEST_F(SkySampling, AFloorAtAWallAndAWallOnAFloorSeeAHalf) {
    const Things floor = {{shapes::quad(1, 1), {}},
                          {shapes::box({1, -5000, -1}, {2, 5000, 5000}), {}}};
    EXPECT_NEAR(share_of_first(floor), 0.5, 0.02);
    const Things wall = {{upright(1, 1), {}}, {shapes::quad(10000, 10000), {-5000, -5000, 0}}};
    EXPECT_NEAR(share_of_first(wall), 0.5, 0.02);
}

TEST_F(SkySampling, RaysBeginOnTheirTriangleAndLeaveIt) {
    with_sampler({{shapes::quad(2, 1), {}}}, [](const SkySampler& sampler, const Mesh& mesh) {
        const auto placed = sampler.placed(mesh, 0);
        ASSERT_TRUE(placed);
        EXPECT_NEAR(placed->area, 2, 1e-9);  // twice
        glm::dvec3 sum(0.0);
        uint32_t near = ray::kNoTriangle;
        for (uint32_t i = 0; i < 256; ++i) {
            const SkySampler::SkyPlace place = sampler.place(mesh, 0, *placed, i, near);
            const SkySampler::SkyRay ray = sampler.ray(place, false);
            EXPECT_TRUE(ray.open);
            EXPECT_NEAR(ray.weights[0] + ray.weights[1] + ray.weights[2], 1, 1e-12);
            EXPECT_GT(ray.from.z, 0);
            EXPECT_LT(ray.from.z, 1e-3);
            EXPECT_GE(ray.from.x, ray.from.y);
            const SkySampler::SkyRay back = sampler.ray(place, true);
            EXPECT_LT(back.from.z, 0);
            EXPECT_LT(back.direction.z, 0);
            const SkySampler::SkyRay opposite = sampler.ray(place, false, true);
            EXPECT_NEAR(opposite.direction.x, -ray.direction.x, 1e-9);
            EXPECT_NEAR(opposite.direction.z, ray.direction.z, 1e-9);
            sum += ray.direction;
        }
        // The mean height of directions weighted by the cosine is two thirds.
        EXPECT_NEAR(sum.z / 256, 2.0 / 3, 0.01);
        EXPECT_NEAR(sum.x / 256, 0, 0.02);
    });
}

TEST_F(SkySampling, WhatIsInABoxLiesInside) {
    for (const double height : {0.0, 3.0}) {
        const Things things = {{shapes::quad(1, 1), {-.5, -.5, height}},
                               {shapes::box({-1, -1, -1}, {1, 1, 1}), {}}};
        with_sampler(things, [&](const SkySampler& sampler, const Mesh& mesh) {
            const auto placed = sampler.placed(mesh, 0);
            ASSERT_TRUE(placed);
            EXPECT_EQ(sampler.lies_inside(mesh, 0, *placed), height == 0);
        });
    }
}

// The rim of a pavement below thatched roofs was black at full detail, where few rays met but roofs.
TEST_F(SkySampling, WhatIsBelowARoofOfOneSheetDoesNotAndWhatIsBelowAGroundDoes) {
    for (const float width : {5.0f, 400.0f}) {
        const Things things = {{shapes::quad(1, 1), {-.5, -.5, -1}},
                               {shapes::quad(width, width), {-width / 2, -width / 2, 0}}};
        with_sampler(things, [&](const SkySampler& sampler, const Mesh& mesh) {
            const auto placed = sampler.placed(mesh, 0);
            ASSERT_TRUE(placed);
            EXPECT_EQ(sampler.lies_inside(mesh, 0, *placed), width > 100);
        });
    }
}
