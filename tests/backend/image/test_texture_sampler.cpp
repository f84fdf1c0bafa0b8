// SPDX-License-Identifier: GPL-3.0-or-later
// Guards texture look-ups: which texel, which channel, in which light, outside the picture too.
#include "base/color.h"
#include "base/error.h"
#include "image/texture_sampler.h"

#include <gtest/gtest.h>
#include <limits>

namespace lodestone {
namespace {

/// 2 x 2: red, green / blue, half covered white (sRGB numbers), top row first.
PicturePtr four_texels(ColorSpace space = ColorSpace::Srgb) {
    image::Image image;
    image.width = image.height = 2;
    image.pixels = {1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1, 1, 1, 1, 0.4f};
    return image::make_picture(image::png_bytes(image), space, "four");
}

Texture closest(PicturePtr picture) {
    Texture texture;
    texture.picture = std::move(picture);
    texture.interpolation = TextureInterpolation::Closest;
    return texture;
}

void expect_color(const glm::dvec3& found, const glm::dvec3& wanted) {
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(found[i], wanted[i], 1e-6) << i;
}

TEST(TextureSampler, WithoutAPictureGivesTheOtherValue) {
    const image::TextureSampler sampler(Texture{}, {0.1, 0.2, 0.3});
    expect_color(sampler.color({0.5, 0.5}), {0.1, 0.2, 0.3});
    EXPECT_EQ(sampler.number({7, -3}), 0.1);
}

TEST(TextureSampler, EveryByteIsDecodedAsTheFormulaSays) {
    image::Image image;
    image.width = 256;
    image.height = 1;
    for (int i = 0; i < 256; ++i)
        image.pixels.insert(image.pixels.end(), {static_cast<float>(i) / 255.0f, 0, 0, 1});
    const PicturePtr picture =
        image::make_picture(image::png_bytes(image), ColorSpace::Srgb, "all bytes");
    const image::Image found = image::decoded(*picture);
    for (size_t i = 0; i < 256; ++i)
        EXPECT_EQ(found.pixels[4 * i], decode_srgb(static_cast<float>(i) / 255.0f)) << i;
}

TEST(TextureSampler, AQuickPngShowsTheSame) {
    const PicturePtr small = four_texels();
    const std::string quick =
        image::png_bytes(image::read(small->bytes, "four"), image::PngEffort::Quick);
    EXPECT_EQ(image::read(quick, "four").pixels, image::read(small->bytes, "four").pixels);
}

TEST(TextureSampler, VZeroIsTheLowestRow) {
    const image::TextureSampler sampler(closest(four_texels()), {});
    expect_color(sampler.color({0.25, 0.75}), {1, 0, 0});
    expect_color(sampler.color({0.75, 0.75}), {0, 1, 0});
    expect_color(sampler.color({0.25, 0.25}), {0, 0, 1});
}

TEST(TextureSampler, BetweenTexelsIsTheirMeanInLinearLight) {
    Texture texture;
    texture.picture = four_texels();
    texture.extension = TextureExtension::Extend;
    const image::TextureSampler sampler(texture, {});
    expect_color(sampler.color({0.5, 0.75}), {0.5, 0.5, 0});
    expect_color(sampler.color({0.5, 1.0}), {0.5, 0.5, 0});
}

TEST(TextureSampler, OutsideGoesByTheExtension) {
    Texture texture = closest(four_texels());
    const glm::dvec2 right(1.25, 0.75);
    expect_color(image::TextureSampler(texture, {}).color(right), {1, 0, 0});
    texture.extension = TextureExtension::Extend;
    expect_color(image::TextureSampler(texture, {}).color(right), {0, 1, 0});
    texture.extension = TextureExtension::Mirror;
    expect_color(image::TextureSampler(texture, {}).color(right), {0, 1, 0});
    expect_color(image::TextureSampler(texture, {}).color({-0.25, 0.75}), {1, 0, 0});
    texture.extension = TextureExtension::Clip;
    expect_color(image::TextureSampler(texture, {}).color(right), {0, 0, 0});
}

TEST(TextureSampler, MappingScaleAndOffsetAreApplied) {
    Texture texture = closest(four_texels());
    texture.to_picture = {0, 1, 0, 1, 0, 0};  // u and v exchanged
    texture.scale = {0.5, 0.5, 0.5};
    texture.offset = {0.1, 0.2, 0.3};
    expect_color(image::TextureSampler(texture, {}).color({0.75, 0.25}), {0.6, 0.2, 0.3});
}

TEST(TextureSampler, NumbersTakeTheirChannel) {
    Texture texture = closest(four_texels(ColorSpace::Linear));
    texture.channel = TextureChannel::Alpha;
    EXPECT_NEAR(image::TextureSampler(texture, {}).number({0.75, 0.25}), 0.4, 1e-6);
    EXPECT_EQ(image::TextureSampler(texture, {}).number({0.25, 0.25}), 1);
    texture.channel = TextureChannel::Green;
    EXPECT_EQ(image::TextureSampler(texture, {}).number({0.75, 0.75}), 1);
    texture.channel = TextureChannel::Color;
    EXPECT_NEAR(image::TextureSampler(texture, {}).number({0.75, 0.75}), 0.7152, 1e-6);
}

TEST(TextureSampler, TheMeanTexelIsWeightedByAlpha) {
    const PicturePtr picture = four_texels();
    EXPECT_NEAR(picture->mean.x, 1.4 / 3.4, 1e-6);
    EXPECT_NEAR(picture->mean.w, 0.85, 1e-6);
}

TEST(TextureSampler, LargePicturesKeepTheirMean) {
    image::Image image;
    image.width = 3000;
    image.height = 2;
    for (int i = 0; i < 6000; ++i)
        image.pixels.insert(image.pixels.end(), {i % 3000 < 1500 ? 1.0f : 0.0f, 0, 0, 1});
    const PicturePtr picture =
        image::make_picture(image::png_bytes(image), ColorSpace::Srgb, "long");
    EXPECT_NEAR(picture->mean.x, 0.5, 1e-6);
    const image::TextureSampler sampler(closest(picture), {});
    expect_color(sampler.color({0.2, 0.5}), {1, 0, 0});
    expect_color(sampler.color({0.8, 0.5}), {0, 0, 0});
}

TEST(TextureSampler, CoordinatesThatAreNoNumbersAreHarmless) {
    const image::TextureSampler sampler(closest(four_texels()), {});
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double far : {nan, 1e300, -1e300, 1e9}) {
        EXPECT_GE(sampler.number({far, 0.5}), 0);
        EXPECT_LE(sampler.number({0.5, far}), 1);
    }
}

TEST(DecodedTexels, ThinThingsThatAreCutKeepTheirShare) {
    // Needles one texel wide, every fourth column: a quarter is there, though no block's mean is.
    image::Image image;
    image.width = image.height = 64;
    for (int i = 0; i < 64 * 64; ++i)
        image.pixels.insert(image.pixels.end(), {1, 1, 1, i % 4 == 0 ? 1.0f : 0.0f});
    Texture texture =
        closest(image::make_picture(image::png_bytes(image), ColorSpace::Srgb, "needles"));
    texture.channel = TextureChannel::Alpha;
    EXPECT_NEAR(image::texels_of(*texture.picture, 16)->least.w, 0.25, 1e-6);
    const image::TexelsPtr cut = image::texels_with_cutoff(texture, 0.5, 16);
    EXPECT_EQ(cut->width, 16);
    EXPECT_TRUE(cut->reduced);
    EXPECT_NEAR(image::TextureSampler(texture, {}, cut).number({0.4, 0.6}), 0.25, 1e-6);
    EXPECT_FALSE(image::texels_of(*texture.picture, 64)->reduced);
}

TEST(DecodedTexels, CacheSharesWhatIsTheSameAndForgetsTheLeastUsed) {
    const auto one_of = [](float gray) {
        image::Image image;
        image.width = image.height = 8;
        for (int i = 0; i < 64; ++i)
            image.pixels.insert(image.pixels.end(), {gray, gray, gray, 1});
        return closest(image::make_picture(image::png_bytes(image), ColorSpace::Srgb, "gray"));
    };
    const size_t each = size_t{8} * 8 * 4 * sizeof(float);
    image::TexelCache cache(256, 2 * each);
    const Texture first = one_of(0);
    const image::TexelsPtr kept = cache.of(first);
    EXPECT_EQ(cache.of(first), kept);
    Texture moved = first;  // another mapping of the same picture
    moved.to_picture[2] = 0.5;
    EXPECT_EQ(cache.of(moved), kept);
    EXPECT_EQ(cache.bytes(), each);
    cache.of(one_of(0.2f));
    cache.of(first);
    cache.of(one_of(0.4f));  // the second one goes
    EXPECT_EQ(cache.bytes(), 2 * each);
    EXPECT_EQ(cache.of(first), kept);
    cache.of(one_of(0.6f));
    cache.of(one_of(0.8f));
    EXPECT_LE(cache.bytes(), 2 * each);
    EXPECT_NE(cache.of(first), kept);
    EXPECT_EQ(cache.of(Texture{}), nullptr);
}

TEST(DecodedTexels, BytesThatAreNotResidentGiveNone) {
    auto absent = std::make_shared<Picture>(*four_texels());
    absent->bytes.clear();
    image::TexelCache cache;
    EXPECT_EQ(cache.of(closest(absent)), nullptr);
}

TEST(Picture, AnUnknownKindIsRefusedByName) {
    try {
        image::make_picture("GIF89a, or so", ColorSpace::Srgb, "Bark");
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("Bark"), std::string::npos);
    }
}

TEST(Picture, EqualBytesHaveEqualHashesAndSpacesDiffer) {
    EXPECT_EQ(four_texels()->hash, four_texels()->hash);
    EXPECT_NE(four_texels()->hash, four_texels(ColorSpace::Linear)->hash);
}

}  // namespace
}  // namespace lodestone
