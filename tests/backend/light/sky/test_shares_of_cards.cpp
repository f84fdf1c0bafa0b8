// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the sky on crossed cards, which show what is seen of a crown and lie inside of it.
#include "backend/light/sky/sky_places.h"
#include "light/sky/joined_surface.h"
#include "scenes/leaf_cards.h"

using namespace lodestone;
using namespace lodestone::light;

namespace {

class SharesOfCards : public SkyPlaces {
protected:
    /// A picture of a disc; each side is another picture.
    static PicturePtr disc(int side) {
        return foliage::picture(side, [](double x, double y) {
            return glm::dvec4(0.1, 0.6, 0.1, std::hypot(x - 0.5, y - 0.5) < 0.48 ? 1 : 0);
        });
    }
    uint32_t leaf(const PicturePtr& picture) { return builder.material(foliage::leaf(picture)); }
    static Mesh sheet(float height) {
        Mesh mesh = foliage::card(1, 1);
        for (glm::vec3& position : mesh.positions)
            position.z = height;
        return mesh;
    }
    /// The mean share of a level that is a sheet in the middle of a pile of leaves, which may be a
    /// group's, joined.
    double mean_in_pile(const PicturePtr& leaves, const PicturePtr& of_level, bool joined = false) {
        Mesh pile = sheet(-0.2F);
        append(pile, sheet(0), {});
        append(pile, sheet(0.2F), {});
        const ObjectIndex original = builder.mesh(pile, {leaf(leaves)});
        const ObjectIndex level = builder.mesh(sheet(0.01F), {leaf(of_level)});
        SkyPlace place(*this, {{original, {}}});
        const std::vector<const Representation*> more{&finest(level)};
        place.surfaces.add(more, {});
        SkyRequest request{place.surfaces.of(finest(level)), {}, &*place.scene, 0.02, 64, 0};
        const std::optional<SkySurface> group =
            joined_surface(place.surfaces, place.occluders, Affine{}, 1000);
        request.original = joined ? &group.value() : &place.surfaces.of(finest(original));
        return sky_shares(request, {}).mean;
    }
};

}  // namespace

TEST_F(SharesOfCards, OfALeafThatStayedAreThoseOfTheLeaf) {
    const PicturePtr leaves = disc(32);
    EXPECT_LT(mean_in_pile(leaves, leaves), 0.45) << "between two others";
}

TEST_F(SharesOfCards, PrunedLeavesOfAGroupHadTheSkyOfItsTop) {
    const PicturePtr leaves = disc(32);
    EXPECT_LT(mean_in_pile(leaves, leaves, true), 0.45) << "between two others";
    EXPECT_GT(mean_in_pile(leaves, disc(48), true), 0.7) << "a card's";
}

TEST_F(SharesOfCards, InsideOfACrownWereThoseOfItsInside) {
    EXPECT_GT(mean_in_pile(disc(32), disc(48)), 0.7) << "of the leaf on top, which it shows";
}
