// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what stand-ins are compared with: all that they stand for, in their frame, the right side
// out, and no more than there is memory for.
#include "light/sky/joined_surface.h"
#include "povray/povray_scenes.h"

using namespace lodestone;
using namespace lodestone::light;
using povray::scenes::Builder;

namespace {

class JoinedSurfaces : public testing::Test {
protected:
    void SetUp() override {
        std::string reason;
        if (!ray::available(&reason))
            GTEST_SKIP() << reason;
    }

    std::optional<SkySurface> joined(const std::vector<std::pair<ObjectIndex, Affine>>& things,
                                     const Affine& world, uint64_t most = kMostJoinedTriangles) {
        std::vector<const Representation*> all;
        std::vector<SkyOccluder> occluders;
        for (const auto& [object, place] : things) {
            all.push_back(&builder.model.objects[object].representations[0]);
            occluders.push_back({all.back(), place});
        }
        SkySurfaces surfaces(builder.model);
        surfaces.add(all, {});
        return joined_surface(surfaces, occluders, world, most);
    }

    Builder builder;
};

}  // namespace

TEST_F(JoinedSurfaces, LieInTheFrameOfTheStandIn) {
    const ObjectIndex box = builder.mesh(shapes::cube());
    const Affine world{glm::dmat3(2.0), {10, 0, 0}};
    const auto found = joined({{box, world}, {box, {glm::dmat3(2.0), {16, 0, 0}}}}, world);
    ASSERT_TRUE(found);
    const Mesh cube = shapes::cube();
    ASSERT_EQ(found->mesh->triangles.size(), 2 * cube.triangles.size());
    Box3 expected;
    for (const glm::vec3& position : cube.positions) {
        expected.add(glm::dvec3(position));
        expected.add(glm::dvec3(position) + glm::dvec3(3, 0, 0));
    }
    Box3 all;
    for (const glm::vec3& position : found->mesh->positions)
        all.add(glm::dvec3(position));
    EXPECT_NEAR(glm::length(all.low - expected.low), 0, 1e-6);
    EXPECT_NEAR(glm::length(all.high - expected.high), 0, 1e-6);
}

TEST_F(JoinedSurfaces, OfMirroredThingsTheFrontsStayOutside) {
    const ObjectIndex box = builder.mesh(shapes::box({1, 1, 1}, {2, 2, 2}));
    const Affine mirrored{glm::dmat3(glm::dvec3(-1, 0, 0), {0, 1, 0}, {0, 0, 1}), {}};
    for (const Affine& world : {Affine{}, mirrored}) {
        const auto found = joined({{box, mirrored}, {box, {}}}, world);
        ASSERT_TRUE(found);
        for (size_t i = 0; i < found->mesh->triangles.size(); ++i) {
            const glm::dvec3 corner(found->mesh->positions[found->mesh->triangles[i].x]);
            const glm::dvec3 middle(corner.x < 0 ? -1.5 : 1.5, 1.5, 1.5);
            EXPECT_GT(glm::dot(area_vector(*found->mesh, i), corner - middle), 0) << i;
        }
    }
}

TEST_F(JoinedSurfaces, OfTooManyTrianglesThereIsNone) {
    const ObjectIndex box = builder.mesh(shapes::cube());
    const std::vector<std::pair<ObjectIndex, Affine>> three(3, {box, {}});
    const size_t triangles = 3 * shapes::cube().triangles.size();
    EXPECT_TRUE(joined(three, {}, triangles));
    EXPECT_FALSE(joined(three, {}, triangles - 1));
    EXPECT_FALSE(joined({}, {}));
    EXPECT_FALSE(joined(three, {glm::dmat3(0.0), {}}));
}

TEST_F(JoinedSurfaces, KnowWhatLightGoesThrough) {
    Material clear;
    clear.alpha = 0.5;
    clear.alpha_mode = AlphaMode::Blend;
    const ObjectIndex leaf = builder.mesh(shapes::quad(1, 1), {builder.material(clear)});
    const ObjectIndex box = builder.mesh(shapes::cube(), {builder.matte({1, 1, 1})});
    const auto found = joined({{leaf, {}}, {box, {}}}, {});
    ASSERT_TRUE(found);
    for (size_t i = 0; i < found->mesh->triangles.size(); ++i)
        EXPECT_EQ(found->opaque_slot(found->mesh->slot(i)), i >= 2) << i;
}
