// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the shade of the sky on floors: also on one that is a box of a few triangles.
#include "povray/povray_scenes.h"
#include "povray_export/lamp/sky_occlusion.h"
#include "scenes/with_rays.h"

using namespace lodestone;
using namespace lodestone::povray;
using scenes::Builder;

namespace {

class SkyGroundsTest : public WithRays {
protected:
    SkyGroundsTest() { builder.model.world.color = glm::dvec3(0.5); }

    /// A slab of 40 x 40 m with a crate of 4 m amid it.
    void add_floor(double height = 1) {
        slab_ = builder.mesh(shapes::box({-20, -20, -static_cast<float>(height)}, {20, 20, 0}));
        builder.place(slab_);
        builder.place(builder.mesh(shapes::box({-2, -2, 0}, {2, 2, 4})));
    }
    /// The triangles that the light on the slab is told for.
    size_t parts() {
        const choose::Cut cut = choose::choose_cut(builder.finish(), scenes::above());
        Problems problems;
        const SkyOcclusion light(builder.model, cut, {}, problems, {});
        for (size_t i = 0; i < cut.chosen.size(); ++i) {
            if (cut.nodes[cut.chosen[i]].object == slab_)
                return light.of(i)->shares->corners.size() / 3;
        }
        return 0;
    }

    Builder builder;
    ObjectIndex slab_ = kNoObject;
};

constexpr size_t kBox = 12;

}  // namespace

// A race track's trees stood on a slab without any shade around them.
TEST_F(SkyGroundsTest, AFloorThatIsABoxIsShadedWhereThingsStand) {
    add_floor();
    EXPECT_GT(parts(), 5 * kBox);
}

TEST_F(SkyGroundsTest, ABlockIsNoFloor) {
    add_floor(20);
    EXPECT_EQ(parts(), kBox);
}

// Sunlit pixels would stand in the room, along the edges of its ceiling.
TEST_F(SkyGroundsTest, ARoofIsNoFloor) {
    add_floor();
    builder.place(builder.mesh(shapes::box({5, 5, -5}, {6, 6, -1})));
    EXPECT_EQ(parts(), kBox);
}

TEST_F(SkyGroundsTest, WhatLiesBesideAFloorChangesNothing) {
    add_floor();
    builder.place(builder.mesh(shapes::box({30, 5, -5}, {31, 6, -1})));
    EXPECT_GT(parts(), 5 * kBox);
}
