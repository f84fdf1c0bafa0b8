// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the levels that a store keeps of what it held before: the newest, within a bound.
#include "scenes/small_models.h"
#include "segment/earlier_levels.h"

#include <gtest/gtest.h>

using namespace lodestone;

namespace {

constexpr uint64_t kFileBytes = 10;

uint64_t ten(const Representation&) {
    return kFileBytes;
}

/// Leaves of one stand-in each, with build hashes from `first` on.
Model built(Hash first, size_t count) {
    Model model;
    for (size_t i = 0; i < count; ++i) {
        const ObjectIndex index =
            models::add_leaf(model, std::to_string(first + i), shapes::cube(),
                             models::colored("color", {0.5, 0.1, 0.01 * double(first)}));
        models::add_level(model, index, 1, shapes::cube());
        model.objects[index].representations[1].materials =
            model.objects[index].representations[0].materials;
        model.objects[index].build_hash = first + i;
    }
    return model;
}

std::vector<Hash> hashes(const Model& model) {
    std::vector<Hash> out;
    for (const Object& object : model.objects)
        out.push_back(object.build_hash);
    return out;
}

}  // namespace

TEST(EarlierLevels, OfNothingAreNone) {
    EXPECT_TRUE(segment::earlier_levels({}, {}, {}, 1000, ten).objects.empty());
    EXPECT_TRUE(segment::earlier_levels(built(1, 3), built(1, 3), {}, 1000, ten).objects.empty());
}

TEST(EarlierLevels, AreWhatIsNoLongerThereTheNewestFirst) {
    const Model made = segment::earlier_levels(built(1, 2), built(2, 3), built(4, 3), 1000, ten);
    EXPECT_EQ(hashes(made), (std::vector<Hash>{3, 4, 5, 6}));
    for (const Object& object : made.objects) {
        for (const Representation& level : object.representations) {
            for (const uint32_t material : level.materials)
                EXPECT_LT(material, made.materials.size());
        }
    }
    EXPECT_EQ(made.materials.size(), 2u);  // each content once
}

TEST(EarlierLevels, WhoseMaterialsHaveAnotherFinishStay) {
    Model now = built(1, 1);
    Model before = built(1, 1);
    now.objects[0].source_hash = 1;
    before.objects[0].source_hash = 2;
    EXPECT_EQ(segment::earlier_levels(now, before, {}, 1000, ten).objects.size(), 1u);
}

TEST(EarlierLevels, AreNoMoreThanTheirBytes) {
    // Each has the finest and one stand-in.
    const Model made = segment::earlier_levels({}, built(1, 5), built(6, 5), 14 * kFileBytes, ten);
    EXPECT_EQ(hashes(made), (std::vector<Hash>{1, 2, 3, 4, 5, 6, 7}));
    EXPECT_TRUE(segment::earlier_levels({}, built(1, 5), {}, 0, ten).objects.empty());
}

TEST(EarlierLevels, AreNoMoreThanAThousandOfAFewObjects) {
    EXPECT_EQ(segment::earlier_levels({}, built(1, 1200), {}, ~uint64_t{0}, ten).objects.size(),
              1000u);
}

TEST(EarlierLevels, HoldNothingThatDeforms) {
    Model before = built(1, 2);
    before.objects[0].bind_hash = 7;
    EXPECT_EQ(hashes(segment::earlier_levels({}, before, {}, 1000, ten)), (std::vector<Hash>{2}));
}

TEST(EarlierLevels, OfGroupsPlaceNothing) {
    Model before = built(1, 1);
    const ObjectIndex group = models::add_group(before, "group", {{0, Affine{}, "one"}});
    before.objects[group].build_hash = 9;
    before.objects[group].sources = {{0, false}};
    models::add_level(before, group, 1, shapes::cube());
    const Model made = segment::earlier_levels({}, before, {}, 1000, ten);
    ASSERT_EQ(hashes(made), (std::vector<Hash>{1, 9}));
    EXPECT_TRUE(made.objects[1].representations[0].assembly().placements.empty());
    EXPECT_LT(made.objects[1].sources[0].material, made.materials.size());
}
