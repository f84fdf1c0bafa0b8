// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what is known of an original once it is measured, each part alone.
#include "hierarchy/counted_error.h"
#include "hierarchy/finest.h"
#include "scenes/small_models.h"
#include "scenes/with_rays.h"

#include <numbers>

using namespace lodestone;

namespace {

class MeasuredFinest : public WithRays {
protected:
    hierarchy::MeasuredFinest measured(const Mesh& mesh,
                                       const hierarchy::FinestOptions& options = {}) {
        return hierarchy::measure_finest(mesh, materials_, texels_, {}, options, {});
    }

    std::vector<Material> materials_{models::colored("red", {0.5, 0.1, 0.1})};
    image::TexelCache texels_;
};

}  // namespace

TEST(CountedErrors, OnlyTheFinestHasNone) {
    EXPECT_EQ(hierarchy::counted_error(0.25, false, 1), 0.25);
    EXPECT_GT(hierarchy::counted_error(0, false, 1), 0);
    EXPECT_EQ(hierarchy::counted_error(0, false, 0), 0);
    EXPECT_GT(hierarchy::counted_error(0.25, true, 1), 0.25);
}

TEST_F(MeasuredFinest, ABallIsSolidAndAsLargeAsItIs) {
    const Mesh ball = shapes::sphere(1);
    const hierarchy::MeasuredFinest finest = measured(ball);
    EXPECT_NEAR(finest.size, 1, 1e-3);
    EXPECT_NEAR(finest.attributes.visible_area, 4 * std::numbers::pi, 0.1);
    EXPECT_TRUE(finest.solid());
    EXPECT_FALSE(finest.refracts());
    EXPECT_FALSE(finest.glows);
    EXPECT_TRUE(finest.patches);
    EXPECT_TRUE(finest.seen_triangles().empty()) << "asked for of groups alone";
    EXPECT_TRUE(finest.is_whole(ball));
}

TEST_F(MeasuredFinest, OfNothingThereIsNothing) {
    const Mesh none;
    EXPECT_TRUE(measured(none).attributes.empty());
}

TEST_F(MeasuredFinest, TheSameRaysFindTheSame) {
    const Mesh mesh = shapes::torus(24, 12);
    const Attributes once = measured(mesh).attributes;
    const Attributes again = measured(mesh).attributes;
    EXPECT_EQ(once.visible_area, again.visible_area);
    EXPECT_EQ(once.centroid, again.centroid);
    EXPECT_EQ(once.moments, again.moments);
}

TEST_F(MeasuredFinest, AFewTrianglesHaveFewRays) {
    const Attributes few = measured(shapes::torus(6, 4)).attributes;
    const Attributes many = measured(shapes::torus(48, 24)).attributes;
    EXPECT_LT(few.rays, many.rays);
    EXPECT_GE(few.rays, many.rays / 2) << "colors are told by them";
    EXPECT_EQ(many.rays, hierarchy::BuildSettings{}.rays);
    EXPECT_LT(few.relative_error, 0.05);
}

TEST_F(MeasuredFinest, AGroupIsToldWhichOfItsTrianglesCanBeSeen) {
    Mesh mesh = shapes::box({-1, -1, -1}, {1, 1, 1});
    const size_t outside = mesh.triangles.size();
    append(mesh, shapes::box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}), {});
    hierarchy::FinestOptions options;
    options.group = true;
    const hierarchy::MeasuredFinest finest = measured(mesh, options);
    ASSERT_EQ(finest.seen_triangles().size(), mesh.triangles.size());
    for (size_t i = 0; i < mesh.triangles.size(); ++i)
        EXPECT_EQ(finest.seen_triangles()[i] != 0, i < outside) << i;
    EXPECT_FALSE(finest.is_whole(subset(mesh, finest.seen_triangles())));
}

TEST_F(MeasuredFinest, AnErrorIsThatOfItsDistance) {
    const Mesh mesh = shapes::sphere(1, 2);
    for (const bool environment : {false, true}) {
        hierarchy::FinestOptions options;
        options.environment = environment;
        options.child_error = 0.01;
        const hierarchy::MeasuredFinest finest = measured(mesh, options);
        EXPECT_GT(finest.error_at(0), 0.01) << "no stand-in is as near as the finest";
        for (const double distance : {0.001, 0.1, 2.0})
            EXPECT_NEAR(finest.distance_for(finest.error_at(distance)), distance, 1e-12);
        EXPECT_EQ(finest.patches.has_value(), !environment);
    }
}

TEST_F(MeasuredFinest, OnlyWhatIsFlatCountsAsALayer) {
    hierarchy::FinestOptions options;
    options.in_layers = true;
    const Mesh road = shapes::box({0, 0, 0}, {8, 4, 0.02});
    const Mesh ball = shapes::sphere(1, 2);
    EXPECT_TRUE(measured(road, options).layered);
    EXPECT_FALSE(measured(ball, options).layered);
    EXPECT_FALSE(measured(road).layered);
    EXPECT_GT(measured(road, options).error_at(0.1), measured(road).error_at(0.1));
    EXPECT_EQ(measured(ball, options).error_at(0.1), measured(ball).error_at(0.1));
}
