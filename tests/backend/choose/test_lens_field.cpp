// SPDX-License-Identifier: GPL-3.0-or-later
// Guards lenses (5.5.5, equation 5.18): their profile, what they touch, what they open and hide.
#include "choose/lens_field.h"
#include "scenes/lens_views.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

using namespace lodestone;
using bent::ball;
using bent::drawn;
using bent::kBall;
using bent::kPair;
using bent::lens;
using models::view_from;

namespace {

constexpr const char* kUntouched = "pair 0 1, pair 1 1";

View through(const DetailLens& lens) {
    View view = view_from(300);
    view.modifiers.lenses = {lens};
    return view;
}

std::string refusal(const Model& model, const View& view) {
    try {
        choose::choose_cut(model, view);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST(Lens, NoneChangesNothing) {
    EXPECT_EQ(drawn(bent::pairs(), view_from(300)), kUntouched);
}

TEST(Lens, ProfileIsTheStrengthInTheMiddleAndOneAtTheRim) {
    EXPECT_DOUBLE_EQ(choose::lens_profile(4, 2, 1, 0), 4);
    EXPECT_NEAR(choose::lens_profile(4, 2, 1, 1), 3.121320343559643, 1e-12);  // 1 + 3 / sqrt(2)
    EXPECT_NEAR(choose::lens_profile(4, 2, 2, 1), 2.5, 1e-12);
    EXPECT_NEAR(choose::lens_profile(4, 2, 1, 2 - 1e-9), 1, 1e-8);
    EXPECT_EQ(choose::lens_profile(4, 2, 1, 2), 1);
    EXPECT_EQ(choose::lens_profile(4, 2, 1, 1e9), 1);
    EXPECT_EQ(choose::lens_profile(4, 2, 0, 1.999), 4);  // no fall-off: a hard rim
    EXPECT_NEAR(choose::lens_profile(0.25, 2, 1, 1), 1 - 0.75 / std::sqrt(2.0), 1e-12);
    EXPECT_EQ(choose::lens_profile(4, 0, 1, 0), 1);
}

TEST(Lens, ReachIsTheDistanceInItsOwnFrame) {
    const Bound five = ball({5, 0, 0}, 1);
    DetailLens sphere = lens(0, 2, 4);
    EXPECT_DOUBLE_EQ(choose::reach(sphere, five).nearest, 4);
    EXPECT_DOUBLE_EQ(choose::reach(sphere, five).farthest, 6);
    sphere.transform.linear = glm::dmat3(2.0);  // half as far
    EXPECT_DOUBLE_EQ(choose::reach(sphere, five).nearest, 2);
    EXPECT_DOUBLE_EQ(choose::reach(sphere, five).farthest, 3);
    sphere.transform.linear = glm::dmat3(-1.0);  // mirrored: no matter
    EXPECT_DOUBLE_EQ(choose::reach(sphere, five).nearest, 4);
    DetailLens box = lens(0, 2, 4);
    box.shape = LensShape::Box;
    const Bound corner = ball({5, 4, 0}, 1);
    EXPECT_DOUBLE_EQ(choose::reach(box, corner).nearest, 4);  // the largest coordinate
    EXPECT_DOUBLE_EQ(choose::reach(box, corner).farthest, 6);
    box.transform.linear[0] = {10, 0, 0};  // ten times as long
    EXPECT_DOUBLE_EQ(choose::reach(box, corner).nearest, 3);
    EXPECT_DOUBLE_EQ(choose::reach(box, ball({0, 0, 0}, 1)).nearest, 0);
}

TEST(Lens, ReachHoldsForEveryPointOfTheBound) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> any(-1, 1);
    const auto vector = [&] { return glm::dvec3(any(random), any(random), any(random)); };
    for (int i = 0; i < 2000; ++i) {
        DetailLens made = lens(0, 1, 2);
        made.shape = i % 2 == 0 ? LensShape::Sphere : LensShape::Box;
        made.transform.linear = glm::dmat3(vector(), vector(), vector());
        made.transform.offset = vector();
        if (std::abs(glm::determinant(made.transform.linear)) < 0.01)
            continue;
        const glm::dvec3 center = 3.0 * vector();
        const Bound bound = ball(center, 0.5);
        const choose::LensReach found = choose::reach(made, bound);
        const glm::dmat3 inverse = glm::inverse(made.transform.linear);
        for (int point = 0; point < 8; ++point) {
            const glm::dvec3 at = center + 0.5 * glm::normalize(vector());
            const glm::dvec3 own = inverse * (at - made.transform.offset);
            const double d = made.shape == LensShape::Sphere
                                 ? glm::length(own)
                                 : std::max({std::abs(own.x), std::abs(own.y), std::abs(own.z)});
            EXPECT_LE(found.nearest, d + 1e-9);
            EXPECT_GE(found.farthest, d - 1e-9);
        }
    }
}

TEST(Lens, OnACornerOpensItsGroupAndLeavesTheFarChildren) {
    // Four times .4 m are more than the pixel's .467; four times .1 m are not, on the left ball
    // only.
    EXPECT_EQ(drawn(bent::pairs(), through(lens(-1, 0.5, 4))),
              "pair 0/left 1, pair 0/right 2, pair 1 1");
}

TEST(Lens, BesideEverythingChangesNothing) {
    EXPECT_EQ(drawn(bent::pairs(), through(lens(-3, 1.9, 64))), kUntouched);
}

TEST(Lens, ABoxReachesIntoItsCorners) {
    DetailLens made = lens(-1.9, 1, 4);
    made.transform.offset.y = 1.9;  // .1 m from the first ball's box along x and y
    made.falloff = 0;
    EXPECT_EQ(drawn(bent::pairs(), through(made)), kUntouched);  // the ball itself is far off
    made.transform.offset.y = 0;
    EXPECT_EQ(drawn(bent::pairs(), through(made)), "pair 0/left 1, pair 0/right 2, pair 1 1");
    made.shape = LensShape::Box;
    made.transform.offset.y = 1.2;
    EXPECT_EQ(drawn(bent::pairs(), through(made)), "pair 0/left 1, pair 0/right 2, pair 1 1");
}

TEST(Lens, BelowOneCoarsensOnlyWhatIsAllInside) {
    Model model = bent::pairs();
    View view = view_from(200);  // .31 m: the pairs are opened
    EXPECT_EQ(drawn(model, view), "pair 0/left 2, pair 0/right 2, pair 1/left 2, pair 1/right 2");
    DetailLens made = lens(1.5, 2.4, 0.5);
    made.falloff = 0;
    view.modifiers.lenses = {made};  // not all of the pair
    EXPECT_EQ(drawn(model, view), "pair 0/left 2, pair 0/right 2, pair 1/left 2, pair 1/right 2");
    view.modifiers.lenses[0].radius = 3;
    EXPECT_EQ(drawn(model, view), "pair 0 1, pair 1/left 2, pair 1/right 2");
}

TEST(Lens, SeveralMultiplyInAnyOrder) {
    const Model model = bent::pairs();
    View view = view_from(300);
    view.modifiers.lenses = {lens(0, 2, 3), lens(1, 8, 5), lens(3, 4, 0.5), lens(9, 2, 7)};
    const std::string once = drawn(model, view);
    EXPECT_NE(once, kUntouched);
    std::reverse(view.modifiers.lenses.begin(), view.modifiers.lenses.end());
    EXPECT_EQ(drawn(model, view), once);
    // Two of strength 2, hard, are one of 4.
    DetailLens two = lens(-1, 0.5, 2);
    two.falloff = 0;
    view.modifiers.lenses = {two, two};
    EXPECT_EQ(drawn(model, view), "pair 0/left 1, pair 0/right 2, pair 1 1");
}

TEST(Lens, TogetherTheyStayWithinTheirRange) {
    const Model model = bent::pairs();
    View view = through(lens(0, 100, 1e30));
    View most = through(lens(0, 100, 64));
    view.modifiers.lenses[0].falloff = most.modifiers.lenses[0].falloff = 0;
    EXPECT_EQ(drawn(model, view), drawn(model, most));
    const choose::Cut cut = choose::choose_cut(model, view);
    EXPECT_EQ(choose::explain_choice(model, view, cut, cut.chosen[0]).chosen.total, 64);
}

TEST(Lens, ForAListRefinesNothingElse) {
    Model model = bent::pairs();
    const ObjectIndex other = models::add_leaf(model, "other", shapes::sphere(1, 3));
    models::add_level(model, other, 0.1, shapes::sphere(1, 1));
    models::add_level(model, other, 0.2, shapes::sphere(1, 0));
    auto assembly = std::make_shared<Assembly>(model.objects[kPair].representations[0].assembly());
    assembly->placements[1].object = other;
    model.objects[kPair].representations[0].payload = std::shared_ptr<const Assembly>(assembly);
    summarize_assemblies(model, bottom_up(model));
    DetailLens made = lens(1.5, 3, 4);
    made.falloff = 0;  // all of pair 0
    made.filter = LensFilter::Refine;
    EXPECT_EQ(drawn(model, through(made)), kUntouched);  // an empty list
    made.objects = {other};
    EXPECT_EQ(drawn(model, through(made)), "pair 0/left 2, pair 0/right 1, pair 1 1");
    made.objects = {kPair};  // a group: and all that is below it
    EXPECT_EQ(drawn(model, through(made)), "pair 0/left 1, pair 0/right 1, pair 1 1");
}

TEST(Lens, ForAListHidesWhatElseIsInside) {
    Model model = bent::pairs();
    DetailLens made = lens(0, 2.5, 1);
    made.filter = LensFilter::Show;
    // The left ball's center is inside, the right one's at 3 m is not.
    EXPECT_EQ(drawn(model, through(made)), "pair 0/right 2, pair 1 1");
    made.objects = {kBall};
    EXPECT_EQ(drawn(model, through(made)), "pair 0/left 2, pair 0/right 2, pair 1 1");
    made.objects.clear();
    made.radius = 100;
    EXPECT_EQ(drawn(model, through(made)), "");
}

TEST(Lens, NonsenseIsRefusedByName) {
    const Model model = bent::pairs();
    const double nan = std::nan("");
    const double infinity = std::numeric_limits<double>::infinity();
    for (const double bad : {-1.0, nan, infinity}) {
        EXPECT_NE(refusal(model, through(lens(0, bad, 2))).find("lens 'lens' has a radius of"),
                  std::string::npos);
        EXPECT_NE(refusal(model, through(lens(0, 1, bad))).find("lens 'lens' has a strength of"),
                  std::string::npos);
        DetailLens made = lens(0, 1, 2);
        made.falloff = bad;
        EXPECT_NE(refusal(model, through(made)).find("fall-off"), std::string::npos);
    }
    EXPECT_EQ(refusal(model, through(lens(0, 1, 0))),
              "lens 'lens' has a strength of 0; more than 0 expected");
    EXPECT_NE(refusal(model, through(lens(nan, 1, 2))), "");
    DetailLens lists = lens(0, 1, 2);
    lists.filter = LensFilter::Refine;
    lists.objects = {99};
    EXPECT_EQ(refusal(model, through(lists)), "lens 'lens' lists object 99 of 3");
    View view = view_from(300);
    view.modifiers.lenses.assign(10000, lens(0, 1, 2));
    EXPECT_EQ(refusal(model, view), "10000 detail lenses; at most 1024");
    lists.objects = {0};
    view.modifiers.lenses.assign(65, lists);
    EXPECT_EQ(refusal(model, view), "lens 'lens' is the 65th with a list of objects; at most 64");
}

TEST(Lens, WithoutInsideHasNoEffect) {
    const Model model = bent::pairs();
    EXPECT_EQ(drawn(model, through(lens(0, 0, 64))), kUntouched);
    DetailLens flat = lens(0, 10, 64);
    flat.transform.linear[2] = {0, 0, 0};
    EXPECT_EQ(drawn(model, through(flat)), kUntouched);
}

TEST(Lens, AGroupCountsAtLeastAsMuchAsAnythingInIt) {
    const Model model = bent::pairs(16);
    std::mt19937 random(11);
    std::uniform_real_distribution<double> any(0, 1);
    for (int round = 0; round < 200; ++round) {
        View view = view_from(20 + 400 * any(random));
        for (int i = 0; i < 4; ++i) {
            DetailLens made =
                lens(50 * any(random), 10 * any(random), std::exp2(8 * any(random) - 4));
            made.shape = i % 2 == 0 ? LensShape::Sphere : LensShape::Box;
            made.falloff = 2 * any(random);
            view.modifiers.lenses.push_back(made);
        }
        const choose::Cut cut = choose::choose_cut(model, view);
        const choose::DetailFactors none;
        for (const uint32_t index : cut.chosen) {
            const choose::CutNode& node = cut.nodes[index];
            const double own = choose::explain_choice(model, view, cut, index).factors.lenses;
            const double above =
                choose::explain_choice(model, view, cut, node.parent).factors.lenses;
            EXPECT_LE(own, above * (1 + 1e-12));
        }
    }
}
