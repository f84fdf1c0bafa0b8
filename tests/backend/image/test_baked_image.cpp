// SPDX-License-Identifier: GPL-3.0-or-later
// Guards baked pictures: every operation's known answer, where texels come from, hostile steps.
#include "base/color.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "image/bake/baked_image.h"
#include "image/texture_sampler.h"

#include <gtest/gtest.h>
#include <limits>

namespace lodestone {
namespace {

using image::BakeOp;
using image::BakeStep;

BakeStep constant(double red, double green, double blue) {
    return {BakeOp::Constant, {0, 0, 0}, {red, green, blue, 1}, {}};
}

/// What an operation makes of up to three constants.
glm::dvec3 of(BakeOp op, const glm::dvec3& a, const glm::dvec3& b = {}, const glm::dvec3& c = {}) {
    const image::Image made =
        image::bake({constant(a.x, a.y, a.z),
                     constant(b.x, b.y, b.z),
                     constant(c.x, c.y, c.z),
                     {op, {0, 1, 2}, {1, 0, 0, 0}, {{0, 0, 0, 1}, {1, 2, 4, 1}}}},
                    {}, 1, 1);
    EXPECT_EQ(made.pixels[3], 1.0f);
    return {made.pixels[0], made.pixels[1], made.pixels[2]};
}

void expect_near(const glm::dvec3& found, const glm::dvec3& wanted, double within = 1e-6) {
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(found[i], wanted[i], within) << i;
}

/// 2 x 2: red, green / blue, half covered white, top row first.
Texture four_texels() {
    image::Image image;
    image.width = image.height = 2;
    image.pixels = {1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1, 1, 1, 1, 0.4f};
    Texture texture;
    texture.picture = image::make_picture(image::png_bytes(image), ColorSpace::Srgb, "four");
    return texture;
}

TEST(Bake, OperationsHaveTheirKnownAnswers) {
    const glm::dvec3 a(0.5, -0.25, 2);
    const glm::dvec3 b(0.25, 0, 4);
    expect_near(of(BakeOp::Channel, a), glm::dvec3(-0.25));
    expect_near(of(BakeOp::Luma, {1, 1, 0}), glm::dvec3(0.9278));
    expect_near(of(BakeOp::Combine, a, b, {7, 8, 9}), {0.5, 0, 9});
    expect_near(of(BakeOp::Add, a, b), {0.75, -0.25, 6});
    expect_near(of(BakeOp::Subtract, a, b), {0.25, -0.25, -2});
    expect_near(of(BakeOp::Multiply, a, b), {0.125, 0, 8});
    expect_near(of(BakeOp::Divide, a, b), {2, 0, 0.5});
    expect_near(of(BakeOp::Power, {4, -8, 0}, {0.5, 0.5, -1}), {2, 0, 0});
    expect_near(of(BakeOp::Minimum, a, b), {0.25, -0.25, 2});
    expect_near(of(BakeOp::Maximum, a, b), {0.5, 0, 4});
    expect_near(of(BakeOp::Mix, a, b, {0.5, 1, 0}), {0.375, 0, 2});
    expect_near(of(BakeOp::Greater, a, b), {1, 0, 0});
    expect_near(of(BakeOp::Absolute, a), {0.5, 0.25, 2});
    expect_near(of(BakeOp::Floor, a), {0, -1, 2});
    expect_near(of(BakeOp::Modulo, {5, -5, 5}, {3, 3, 0}), {2, -2, 0});
    expect_near(of(BakeOp::Ramp, {0.25, 9, 9}), {0.25, 0.5, 1});
    expect_near(of(BakeOp::Curves, {0.25, 0.5, 7}), {0.25, 1, 4});
    expect_near(of(BakeOp::ToHsv, {0.5, 0.25, 0.25}), {0, 0.5, 0.5});
    expect_near(of(BakeOp::FromHsv, {1.0 / 3, 1, 0.5}), {0, 0.5, 0});
    expect_near(of(BakeOp::ToSrgb, {0.5, 1, 0}), {0.7353570, 1, 0});
    expect_near(of(BakeOp::FromSrgb, {0.7353570, 1, 0}), {0.5, 1, 0});
}

TEST(Bake, ValuesThatAreKeptAreThoseOfTheirNumbers) {
    PcgRandom random(1, 1);
    for (int i = 0; i < 3000; ++i) {  // more numbers than are kept
        const glm::dvec3 x(random.uniform(), 4 * random.uniform(), 1e-3 * random.uniform());
        const glm::dvec3 encoded = of(BakeOp::ToSrgb, x);
        const glm::dvec3 decoded = of(BakeOp::FromSrgb, -x);
        for (int c = 0; c < 3; ++c) {
            ASSERT_EQ(encoded[c], double{encode_srgb(static_cast<float>(x[c]))});
            ASSERT_EQ(decoded[c], double{decode_srgb(static_cast<float>(-x[c]))});
        }
    }
}

TEST(Bake, TexelsOfTheSameSizeAreCopied) {
    const image::Image made = image::bake({{BakeOp::Texel, {}, {}, {}}}, {four_texels()}, 2, 2);
    const std::vector<float> wanted = {1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1, 1, 1, 1, 1};
    EXPECT_EQ(made.pixels, wanted);
}

TEST(Bake, TexelsOfAnotherMappingAreLookedUpThere) {
    Texture turned = four_texels();
    turned.to_picture = {0, 1, 0, 1, 0, 0};  // u and v change places
    const image::Image made = image::bake({{BakeOp::Texel, {0, 0, 0}, {}, {}},
                                           {BakeOp::Texel, {1, 0, 0}, {}, {}},
                                           {BakeOp::Multiply, {0, 1, 0}, {}, {}}},
                                          {four_texels(), turned}, 2, 2);
    // Transposed along v = u: the top left and the lower right texel change places
    const std::vector<float> wanted = {1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1, 1, 0, 0, 1};
    for (size_t i = 0; i < 16; ++i)
        EXPECT_EQ(made.pixels[i], wanted[i]) << i;
}

TEST(Bake, AlphaIsAChannelOfATexel) {
    const image::Image made =
        image::bake({{BakeOp::Texel, {}, {}, {}}, {BakeOp::Channel, {0, 0, 0}, {3, 0, 0, 0}, {}}},
                    {four_texels()}, 2, 2);
    EXPECT_NEAR(made.pixels[12], 0.4, 1e-6);
}

TEST(Bake, PicturesKeepColorEncodedAndDataAsItIs) {
    const std::vector<BakeStep> half = {constant(0.5, 0.5, 0.5)};
    const PicturePtr color = image::bake_picture(half, {}, 3, 2, ColorSpace::Srgb, "color");
    const PicturePtr data = image::bake_picture(half, {}, 3, 2, ColorSpace::Linear, "data");
    EXPECT_NEAR(color->mean.x, 0.5, 0.004);
    EXPECT_NEAR(data->mean.x, 0.5, 0.004);
    EXPECT_NE(color->bytes, data->bytes);
    EXPECT_EQ(color->width * color->height, 6);
    const PicturePtr again = image::bake_picture(half, {}, 3, 2, ColorSpace::Srgb, "again");
    EXPECT_EQ(again->hash, color->hash);
    EXPECT_EQ(again->name, "again");
}

TEST(Bake, IsTheSameOnOneThreadAndOnAll) {
    Texture texture = four_texels();
    texture.to_picture = {0.7, 0.3, 0.1, -0.2, 1.9, 0.4};
    const std::vector<BakeStep> steps = {{BakeOp::Texel, {}, {}, {}},
                                         {BakeOp::ToHsv, {0, 0, 0}, {}, {}}};
    const image::Image all = image::bake(steps, {texture}, 64, 48);
    const ThreadLimit limit(1);
    EXPECT_EQ(image::bake(steps, {texture}, 64, 48).pixels, all.pixels);
}

TEST(Bake, WhatIsNoNumberIsBlack) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    expect_near(of(BakeOp::Add, {none, 1, 1}, {1, 1, 1}), {0, 2, 2});
}

TEST(Bake, ImpossibleStepsAreRefused) {
    const auto refused = [](const std::vector<BakeStep>& steps, int side = 1) {
        EXPECT_THROW(image::bake(steps, {four_texels()}, side, side), Error);
    };
    refused({});
    refused(std::vector<BakeStep>(image::kMostBakeSteps + 1, constant(0, 0, 0)));
    refused({{BakeOp::Luma, {0, 0, 0}, {}, {}}});                     // itself
    refused({constant(0, 0, 0), {BakeOp::Add, {0, 7, 0}, {}, {}}});   // a later one
    refused({{BakeOp::Texel, {1, 0, 0}, {}, {}}});                    // no such texture
    refused({constant(0, 0, 0), {BakeOp::Ramp, {0, 0, 0}, {}, {}}});  // no table
    refused({constant(0, 0, 0), {BakeOp::Channel, {0, 0, 0}, {-1, 0, 0, 0}, {}}});
    refused({{static_cast<BakeOp>(99), {0, 0, 0}, {}, {}}});
    refused({constant(0, 0, 0)}, 0);
    refused({constant(0, 0, 0)}, image::kMostBakeSide + 1);
}

TEST(Bake, StopsWhenItIsCancelled) {
    const int32_t cancel = 1;
    EXPECT_THROW(image::bake({constant(0, 0, 0)}, {}, 512, 512, Job(&cancel, nullptr, nullptr)),
                 Error);
}

}  // namespace
}  // namespace lodestone
