// SPDX-License-Identifier: GPL-3.0-or-later
// Guards pictures that stay decoded for a while: the same pixels, as long as anybody wants them.
#include "base/error.h"
#include "image/kept_pixels.h"
#include "image/texture_sampler.h"

#include <gtest/gtest.h>

namespace lodestone::image {
namespace {

PicturePtr gray(float value, ColorSpace space = ColorSpace::Srgb) {
    Image image;
    image.width = 3;
    image.height = 2;
    image.pixels.assign(4 * image.size(), value);
    for (size_t i = 3; i < image.pixels.size(); i += 4)
        image.pixels[i] = 1;
    return make_picture(packed(image), PngEffort::Quick, space, "gray");
}

TEST(KeptPixels, APictureIsDecodedAnewWhereNobodyKeepsIt) {
    const PicturePtr picture = gray(0.5f);
    const PackedPtr first = packed(*picture);
    EXPECT_NE(packed(*picture), first);
}

TEST(KeptPixels, APictureIsDecodedOnceUntilTheLastKeeperIsGone) {
    const PicturePtr picture = gray(0.25f);
    auto outer = std::make_unique<KeptPixels>();
    const PackedPtr first = packed(*picture);
    {
        const KeptPixels inner;
        EXPECT_EQ(packed(*picture), first);
    }
    EXPECT_EQ(packed(*picture), first);
    outer.reset();
    EXPECT_NE(packed(*picture), first);
    EXPECT_EQ(first->row(1)[0], 64) << "who holds pixels keeps them";
}

TEST(KeptPixels, AnotherPictureIsNotMistakenForIt) {
    const KeptPixels keep;
    const PackedPtr dark = packed(*gray(0.0f));
    EXPECT_EQ(dark->row(0)[0], 0);
    EXPECT_EQ(packed(*gray(1.0f))->row(0)[0], 255);
    EXPECT_EQ(packed(*gray(0.0f)), dark) << "a picture of the same bytes has the same pixels";
}

TEST(KeptPixels, ABrokenPictureIsAnErrorEachTime) {
    const KeptPixels keep;
    Picture broken = *gray(0.75f);
    broken.bytes.resize(40);
    broken.hash = 12345;
    EXPECT_THROW(packed(broken), Error);
    EXPECT_THROW(packed(broken), Error);
}

}  // namespace
}  // namespace lodestone::image
