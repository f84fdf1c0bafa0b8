// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the shares of opaque sheets, and of what lies below them.
#include "backend/light/sky/sky_places.h"

#include <glm/gtc/matrix_transform.hpp>

using namespace lodestone;
using namespace lodestone::light;

namespace {

class SharesOfSheets : public SkyPlaces {
protected:
    /// A thing that hides the sky, placed at a height, or lower below the origin.
    static Affine at(const glm::dvec3& offset) { return {glm::dmat3(1.0), offset}; }

    double mean_of_first(const std::vector<std::pair<ObjectIndex, Affine>>& things,
                         std::span<const uint8_t> behind = {}) {
        const SkyPlace place(*this, things);
        SkyRequest request{
            place.surfaces.of(finest(things[0].first)), things[0].second, &*place.scene, 0, 512, 0};
        request.behind = behind;
        return sky_shares(request, {}).mean;
    }
};

}  // namespace

// What lay below a roof of one sheet, whose back was met, counted as if it lay inside of something,
// and was as light as if there were no roof.
TEST_F(SharesOfSheets, AFloorBelowARoofIsAsDarkWhicheverWayTheRoofFaces) {
    const ObjectIndex floor = builder.mesh(shapes::quad(4, 4));
    const ObjectIndex up = builder.mesh(shapes::quad(4, 4));
    Mesh turned = shapes::quad(4, 4);
    for (Triangle& t : turned.triangles)
        std::swap(t.y, t.z);
    const ObjectIndex down = builder.mesh(turned);
    const double below_down = mean_of_first({{floor, {}}, {down, at({0, 0, 1})}});
    // Two squares four times as wide as they are apart see 0.63 of each other.
    EXPECT_NEAR(below_down, 1 - 0.63, 0.02);
    EXPECT_NEAR(mean_of_first({{floor, {}}, {up, at({0, 0, 1})}}), below_down, 0.04);
}

TEST_F(SharesOfSheets, ASheetThatIsSeenFromBehindHasTheLightOfItsBack) {
    const ObjectIndex roof = builder.mesh(shapes::quad(4, 4));
    const ObjectIndex ground = builder.mesh(shapes::quad(400, 400));
    const std::vector<std::pair<ObjectIndex, Affine>> things = {{roof, at({198, 198, 1})},
                                                                {ground, {}}};
    EXPECT_NEAR(mean_of_first(things), 1, 0.01);
    EXPECT_NEAR(mean_of_first(things, std::vector<uint8_t>{1, 1}), 0, 0.02);
    // Half of it.
    EXPECT_NEAR(mean_of_first(things, std::vector<uint8_t>{1, 0}), 0.5, 0.02);
    // A wall sees half a sky on both sides.
    const Affine wall{glm::dmat3(glm::rotate(glm::dmat4(1.0), kPi / 2, {1.0, 0.0, 0.0})),
                      {198, 200, 0}};
    EXPECT_NEAR(mean_of_first({{roof, wall}, {ground, {}}}), 0.5, 0.03);
    EXPECT_NEAR(mean_of_first({{roof, wall}, {ground, {}}}, std::vector<uint8_t>{1, 1}), 0.5, 0.03);
}

TEST_F(SharesOfSheets, TheSidesOfOneCornerAreApart) {
    const ObjectIndex roof = builder.mesh(shapes::quad(4, 4));
    const ObjectIndex ground = builder.mesh(shapes::quad(400, 400));
    const SkyPlace place(*this, {{roof, at({198, 198, 1})}, {ground, {}}});
    SkyRequest request{place.surfaces.of(finest(roof)), at({198, 198, 1}), &*place.scene, 0, 64, 0};
    const std::vector<uint8_t> behind = {1, 0};
    request.behind = behind;
    const SkyShares shares = sky_shares(request, {});
    EXPECT_EQ(shares.behind, behind);
    ASSERT_EQ(shares.corners.size(), 6u);
    for (size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(share_of_byte(shares.corners[i]), i < 3 ? 0 : 1, 0.05);
    // They are kept, and are those of this side alone.
    const auto back = SkyShares::of_bytes(shares.bytes(), 2);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->behind, behind);
    EXPECT_TRUE(covers(*back, {}, behind));
    EXPECT_FALSE(covers(*back, {}));
    EXPECT_TRUE(covers(*back, std::vector<uint8_t>{0, 1}));
    EXPECT_FALSE(covers(*back, {}, std::vector<uint8_t>{1, 1}));
    EXPECT_FALSE(covers(*back, {}, std::vector<uint8_t>{1, 0, 0}));
}
