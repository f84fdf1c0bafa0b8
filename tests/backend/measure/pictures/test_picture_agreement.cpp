// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the error of what is not solid: pictures that agree, and from which size on.
#include "base/parallel.h"
#include "measure/pictures/picture_agreement.h"
#include "scenes/leaf_cards.h"
#include "scenes/with_rays.h"

#include <gtest/gtest.h>

using namespace lodestone;
using measure::AgreementReference;
using measure::PictureAgreement;

namespace {

class Agreements : public WithRays {};

ray::SkinPtr skin(const std::vector<Material>& materials) {
    image::TexelCache texels;
    return std::make_shared<const ray::MeshSkin>(materials, texels);
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

/// A dark back of 2 m x 2 m, and two rows of eight red books before it, 0.4 m deep; only every
/// `nth` of them, and each smaller by that much on all sides.
Mesh bookcase(int nth, double smaller) {
    Mesh mesh;
    const auto add = [&](const glm::dvec3& low, const glm::dvec3& high, uint16_t slot) {
        Mesh box = shapes::cube();
        glm::vec3 least(1e9f);
        glm::vec3 most(-1e9f);
        for (const glm::vec3& position : box.positions) {
            least = glm::min(least, position);
            most = glm::max(most, position);
        }
        for (glm::vec3& position : box.positions)
            position = glm::vec3(low) + (position - least) / (most - least) * glm::vec3(high - low);
        box.normals.clear();
        box.slots.assign(box.triangles.size(), slot);
        append(mesh, box, {});
    };
    add({0, 0, 0}, {2, 0.05, 2}, 0);
    for (int i = 0; i < 16; i += nth) {
        const int column = i / 2;
        const glm::dvec3 low(0.25 * column, 0.05, i % 2);
        add(low + smaller, low + glm::dvec3(0.25, 0.4, 1) - smaller, 1);
    }
    return mesh;
}

ray::SkinPtr bookcase_skin() {
    std::vector<Material> materials(2);
    materials[0].base_color = glm::dvec3(0.03);
    materials[1].base_color = {0.6, 0.2, 0.1};
    return skin(materials);
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
    const PictureAgreement same = AgreementReference(ball, plain(0.5), 1).of(ball, plain(0.5));
    EXPECT_LT(same.error, 2 * 2 * 1.1 * std::sqrt(3.0) / AgreementReference::kSide * 1.001);
    EXPECT_DOUBLE_EQ(same.coverage, 1);
    EXPECT_DOUBLE_EQ(same.light.y, 1);
}

TEST_F(Agreements, WhatIsHalfAsBrightNeverAgreesAndTellsByHowMuch) {
    const Mesh ball = shapes::sphere(1, 3);
    const PictureAgreement dark = AgreementReference(ball, plain(0.6), 1).of(ball, plain(0.3));
    EXPECT_NEAR(dark.light.x, 2, 1e-6);
    EXPECT_GT(dark.error, 2);
    EXPECT_LT(AgreementReference(ball, plain(0.6), 1).of(ball, plain(0.55)).error, 0.1);
}

TEST_F(Agreements, PicturesTracedOnceServeForEveryPlainColor) {
    const AgreementReference reference(grid(3, 0), plain(0.5), 1);
    const Mesh other = grid(3, 0.1);
    const AgreementReference::TracedPictures traced = reference.trace(other, plain(0.9));
    for (const double brightness : {0.1, 0.5, 0.9}) {
        const PictureAgreement fresh = reference.of(other, plain(brightness));
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
    const PictureAgreement thin = reference.of(grid(4, 0, 0.05), nullptr);
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

TEST_F(Agreements, BooksThatAreGoneAreSeenThroughTheirGapsAndBooksThatShrinkAreNot) {
    const ray::SkinPtr skin = bookcase_skin();
    for (const int side : {AgreementReference::kSide, AgreementReference::kBrightSide}) {
        const Mesh full = bookcase(1, 0);
        const AgreementReference reference(full, skin, 1, side);
        const auto gaps = [&](const Mesh& level, double off) {
            return reference.gap_error(reference.trace(level, skin), skin, off);
        };
        EXPECT_EQ(gaps(full, 0.001), 0);
        EXPECT_EQ(gaps(bookcase(1, 0.02), 0.02), 0) << "as near as distances say";
        EXPECT_GT(gaps(bookcase(2, 0), 0.02), 0.5) << "half of them, though the back is near";
        EXPECT_GT(gaps(Mesh{}, 0.02), 2) << "nothing is left";
    }
}

TEST_F(Agreements, WhatIsFartherBehindIsNoGapWhereItLooksTheSame) {
    const Mesh full = bookcase(1, 0);
    const Mesh half = bookcase(2, 0);
    std::vector<Material> alike(2);
    const ray::SkinPtr same = skin(alike);
    const AgreementReference reference(full, same, 1);
    const double apart =
        AgreementReference(full, bookcase_skin(), 1)
            .gap_error(reference.trace(half, bookcase_skin()), bookcase_skin(), 0.02);
    EXPECT_LT(reference.gap_error(reference.trace(half, same), same, 0.02), 0.7 * apart);
    EXPECT_EQ(AgreementReference(Mesh{}, same, 1).gap_error(reference.trace(half, same), same, 0.1),
              0);
}

TEST_F(Agreements, SidesOfTheSameSurfaceGetItsColors) {
    // A cube whose sides are of six colors; of the white stand-in each side gets its own.
    Mesh cube = shapes::box({0, 0, 0}, {1, 1, 1});
    cube.slots.clear();
    std::vector<Material> materials(6);
    std::vector<uint32_t> side_of;
    for (size_t i = 0; i < cube.triangles.size(); ++i) {
        side_of.push_back(static_cast<uint32_t>(i / 2));
        cube.slots.push_back(static_cast<uint16_t>(i / 2));
    }
    for (size_t side = 0; side < 6; ++side)
        materials[side].base_color = {0.1 * (1.0 + static_cast<double>(side)), 0.5, 0};
    const AgreementReference reference(cube, skin(materials), 1, AgreementReference::kCoarseSide);
    Mesh plain_cube = cube;
    plain_cube.slots.clear();
    const auto colors = reference.side_colors(reference.trace(plain_cube, plain(0.8)), side_of, 6);
    ASSERT_EQ(colors.size(), 6u);
    size_t seen = 0;
    for (size_t side = 0; side < 6; ++side) {
        if (!(colors[side].w > 0))
            continue;
        ++seen;
        EXPECT_NEAR(colors[side].x, materials[side].base_color.x, 1e-5);
        EXPECT_NEAR(colors[side].y, 0.5, 1e-5);
        EXPECT_NEAR(colors[side].z, 0, 1e-9);
    }
    EXPECT_GE(seen, 3u);  // pictures are taken along axes, not from both of their ends
}

TEST_F(Agreements, NothingSendsNoLightToSides) {
    const Mesh cube = shapes::box({0, 0, 0}, {1, 1, 1});
    const std::vector<uint32_t> one_side(cube.triangles.size(), 0);
    const AgreementReference nothing({}, plain(0.5), 1);
    EXPECT_EQ(nothing.side_colors(nothing.trace(cube, plain(0.5)), one_side, 1),
              std::vector<glm::dvec4>{glm::dvec4(0.0)});
    const AgreementReference reference(cube, plain(0.5), 1, AgreementReference::kCoarseSide);
    EXPECT_TRUE(reference.side_colors(reference.trace({}, plain(0.5)), {}, 0).empty());
}

TEST_F(Agreements, LightOfCrownsCountsOverFourPixels) {
    // Checkered in black and white, and gray of the same mean: alike where a pixel has both.
    const auto checkered = [](int squares) {
        Material material;
        const PicturePtr picture = foliage::picture(256, [squares](double x, double y) {
            const int at = static_cast<int>(x * squares) + static_cast<int>(y * squares);
            return glm::dvec4(glm::dvec3(at % 2 == 0 ? 1.0 : 0.0), 1);
        });
        material.base_color = glm::dvec3(picture->mean);
        material.base_color_texture = foliage::texture(picture);
        return skin({material});
    };
    const Mesh mesh = foliage::card(2, 2);
    const ray::SkinPtr squares = checkered(8);
    const ray::MeshScene scene(mesh, squares);
    const AgreementReference plainly(mesh, scene, squares, 1, AgreementReference::kSide, {});
    const AgreementReference crown(mesh, scene, squares, 1, AgreementReference::kSide, {},
                                   measure::PictureViews::OfCrowns);
    const double error = plainly.of(mesh, plain(0.5)).error;
    EXPECT_GT(error, 0.25) << "squares are as large";
    EXPECT_LT(crown.of(mesh, plain(0.5)).error, 0.7 * error);
    // Coverage counts in pixels for both: half of the card is no card.
    Mesh half = foliage::card(1, 2);
    EXPECT_GT(crown.of(half, squares).error, 0.7 * plainly.of(half, squares).error);
}

TEST_F(Agreements, TwiceTheSamplesTellHalfTheError) {
    const Mesh mesh = foliage::card(2, 2);
    EXPECT_EQ(AgreementReference(Mesh{}, plain(0.5), 1).least_error(), 0);
    const AgreementReference few(mesh, plain(0.5), 1);
    const AgreementReference many(mesh, plain(0.5), 1, AgreementReference::kFineSide);
    EXPECT_DOUBLE_EQ(many.least_error(), 0.5 * few.least_error());
    const AgreementReference coarse(mesh, plain(0.5), 1, AgreementReference::kCoarseSide);
    EXPECT_DOUBLE_EQ(coarse.of(mesh, plain(0.5)).error, coarse.least_error()) << "3 of 45";
    EXPECT_DOUBLE_EQ(few.of(mesh, plain(0.5)).error, few.least_error());
    EXPECT_DOUBLE_EQ(many.of(mesh, plain(0.5)).error, many.least_error());
    EXPECT_GT(many.of(mesh, plain(0.1)).error, 2) << "another color at any size";
}

TEST_F(Agreements, CrownsAreSeenFromAboveTheHorizon) {
    // A level sheet whose underside nobody above sees: two sheets, the lower one of another color.
    Mesh both = shapes::quad(2, 2);
    Mesh lower = shapes::quad(2, 2);
    for (glm::vec3& position : lower.positions)
        position.z -= 0.01f;
    append(both, lower, {}, 1);
    Material dark;
    dark.base_color = glm::dvec3(0.1);
    Material bright;
    bright.base_color = glm::dvec3(0.8);
    const ray::SkinPtr one = skin({bright, bright});
    const ray::SkinPtr two = skin({bright, dark});
    const ray::MeshScene scene(both, one);
    const AgreementReference plainly(both, scene, one, 1, AgreementReference::kSide, {});
    const AgreementReference crown(both, scene, one, 1, AgreementReference::kSide, {},
                                   measure::PictureViews::OfCrowns);
    const AgreementReference above(both, scene, one, 1, AgreementReference::kSide, {},
                                   measure::PictureViews::FromAbove);
    EXPECT_GT(plainly.of(both, two).light.x, 1.1);
    EXPECT_NEAR(crown.of(both, two).light.x, 1, 0.02);
    EXPECT_NEAR(above.of(both, two).light.x, 1, 0.02);
}

TEST_F(Agreements, PicturesShowTheSameDrawnAndSearched) {
    // Triangles without area are never seen, but so many are not drawn one by one.
    const auto crowded = [](Mesh mesh) {
        for (int i = 0; i < 20000; ++i)
            mesh.triangles.push_back({0, 0, 1});
        if (!mesh.slots.empty())
            mesh.slots.resize(mesh.triangles.size(), 0);
        return mesh;
    };
    const Mesh finest = bookcase(1, 0);
    const Mesh level = bookcase(2, 0.01);
    Material back;
    back.base_color = glm::dvec3(0.1);
    Material red;
    red.base_color = {0.7, 0.1, 0.1};
    const ray::SkinPtr shown = skin({back, red});
    const PictureAgreement drawn =
        AgreementReference(finest, shown, 1, AgreementReference::kBrightSide).of(level, shown);
    const AgreementReference searched(crowded(finest), shown, 1, AgreementReference::kBrightSide);
    for (const Mesh& same : {level, crowded(level)}) {
        const PictureAgreement other = searched.of(same, shown);
        EXPECT_NEAR(other.error, drawn.error, 1e-3 * drawn.error);
        EXPECT_NEAR(other.coverage, drawn.coverage, 1e-3);
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(other.light[i], drawn.light[i], 1e-3);
    }
    EXPECT_GT(drawn.error, 0);
    EXPECT_LT(drawn.coverage, 1);
}
