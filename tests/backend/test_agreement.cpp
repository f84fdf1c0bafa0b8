// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the error of what is not solid: pictures that agree, and from which size on.
#include "backend/foliage.h"
#include "backend/with_rays.h"
#include "base/parallel.h"
#include "measure/agreement.h"

#include <gtest/gtest.h>

using namespace lodestone;
using measure::Agreement;
using measure::AgreementReference;

namespace {

class Agreements : public WithRays {};

ray::SkinPtr skin(const std::vector<Material>& materials) {
    image::TexelCache texels;
    return std::make_shared<const ray::Skin>(materials, texels);
}

ray::SkinPtr plain(double brightness) {
    Material material;
    material.base_color = glm::dvec3(brightness);
    return skin({material});
}

/// Balls of radius 0.1 on a grid of `side`^3 points 1 m apart, moved along x.
Mesh grid(int side, double moved, double radius = 0.1) {
    Mesh mesh;
    for (int i = 0; i < side * side * side; ++i) {
        Affine place;
        place.offset = {i % side + moved, i / side % side, i / side / side};
        append(mesh, shapes::sphere(radius, 1), place);
    }
    return mesh;
}

}  // namespace

TEST_F(Agreements, NothingAgreesWithNothingAndWithNothingElse) {
    EXPECT_EQ(AgreementReference(Mesh{}, nullptr, 1).of(Mesh{}, nullptr).error, 0);
    const Mesh ball = shapes::sphere(1, 2);
    const AgreementReference reference(ball, nullptr, 1);
    EXPECT_GT(reference.of(Mesh{}, nullptr).error, 2) << "not even in one pixel";
}

TEST_F(Agreements, TheSameThingAgreesAtTheSmallestPixel) {
    const Mesh ball = shapes::sphere(1, 3);
    const Agreement same = AgreementReference(ball, plain(0.5), 1).of(ball, plain(0.5));
    EXPECT_LT(same.error, 2 * 2 * 1.1 * std::sqrt(3.0) / AgreementReference::kSide * 1.001);
    EXPECT_DOUBLE_EQ(same.coverage, 1);
    EXPECT_DOUBLE_EQ(same.light.y, 1);
}

TEST_F(Agreements, WhatIsHalfAsBrightNeverAgreesAndTellsByHowMuch) {
    const Mesh ball = shapes::sphere(1, 3);
    const Agreement dark = AgreementReference(ball, plain(0.6), 1).of(ball, plain(0.3));
    EXPECT_NEAR(dark.light.x, 2, 1e-6);
    EXPECT_GT(dark.error, 2);
    EXPECT_LT(AgreementReference(ball, plain(0.6), 1).of(ball, plain(0.55)).error, 0.1);
}

TEST_F(Agreements, PicturesTracedOnceServeForEveryPlainColor) {
    const AgreementReference reference(grid(3, 0), plain(0.5), 1);
    const Mesh other = grid(3, 0.1);
    const AgreementReference::Traced traced = reference.trace(other, plain(0.9));
    for (const double brightness : {0.1, 0.5, 0.9}) {
        const Agreement fresh = reference.of(other, plain(brightness));
        EXPECT_EQ(reference.of(traced, plain(brightness)).error, fresh.error);
        EXPECT_EQ(reference.brightness_of(traced, plain(brightness)).light, fresh.light);
    }
}

TEST_F(Agreements, MovedPartsAgreeFromAboutAPixelThatIsMuchLargerThanTheMove) {
    const AgreementReference reference(grid(4, 0), nullptr, 1);
    double last = 0;
    for (const double moved : {0.02, 0.1, 0.4}) {
        const double error = reference.of(grid(4, moved), nullptr).error;
        EXPECT_GT(error, last) << moved;
        EXPECT_GT(error, moved);
        EXPECT_LT(error, 12 * moved + 0.2) << moved;
        last = error;
    }
}

TEST_F(Agreements, ThinnerFoliageDisagreesAtEverySizeAndIsToldByItsCoverage) {
    const AgreementReference reference(grid(4, 0), nullptr, 1);
    const Agreement thin = reference.of(grid(4, 0, 0.05), nullptr);
    EXPECT_NEAR(thin.coverage, 0.3, 0.1);
    EXPECT_GT(thin.error, 2);
}

TEST_F(Agreements, AlphaIsNotThere) {
    const PicturePtr half = foliage::left_half();
    Mesh card = foliage::card(2, 2);
    const AgreementReference reference(card, skin({foliage::leaf(half)}), 1);
    Material green;
    green.base_color = {0.1, 0.6, 0.1};
    EXPECT_LT(reference.of(shapes::quad(1, 2), skin({green})).error, 0.2);
    EXPECT_GT(reference.of(shapes::quad(2, 2), skin({green})).error, 0.5);
}

TEST_F(Agreements, SameOnOneAndOnManyThreadsAndWhereverItLies) {
    Mesh a;
    Mesh b;
    Affine far;
    far.offset = {4000, -300, 20};
    append(a, grid(3, 0), far);
    append(b, grid(3, 0.1), far);
    const double many = AgreementReference(a, nullptr, 1).of(b, nullptr).error;
    const ThreadLimit limit(1);
    EXPECT_EQ(AgreementReference(a, nullptr, 1).of(b, nullptr).error, many);
    EXPECT_NEAR(AgreementReference(grid(3, 0), nullptr, 1).of(grid(3, 0.1), nullptr).error, many,
                0.15 * many);
}
