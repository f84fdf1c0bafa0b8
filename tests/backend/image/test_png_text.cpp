// SPDX-License-Identifier: GPL-3.0-or-later
// Guards text in PNGs: it is added, replaced and read back, and the pixels stay what they were.
#include "base/error.h"
#include "image/image.h"
#include "image/png_text.h"

#include <gtest/gtest.h>

using namespace lodestone;
using image::TextLines;

namespace {

std::string picture() {
    image::Image gradient;
    gradient.width = 5;
    gradient.height = 3;
    for (int i = 0; i < 15; ++i) {
        for (const float value : {static_cast<float>(i) / 15.0f, 0.5f, 0.25f, 1.0f})
            gradient.pixels.push_back(value);
    }
    return image::png_bytes(gradient);
}

}  // namespace

TEST(PngText, NoLinesChangeNothing) {
    EXPECT_EQ(image::with_png_text(picture(), {}, "it"), picture());
    EXPECT_TRUE(image::png_text(picture(), "it").empty());
}

TEST(PngText, LinesComeBackAndThePixelsStay) {
    const TextLines lines{{"Lodestone", "0.1.0"}, {"Empty", ""}};
    const std::string with = image::with_png_text(picture(), lines, "it");
    EXPECT_EQ(image::png_text(with, "it"), lines);
    EXPECT_EQ(image::read(with, "it").pixels, image::read(picture(), "it").pixels);
}

TEST(PngText, ALineOfTheSameKeywordIsReplaced) {
    const std::string once = image::with_png_text(picture(), {{"A", "1"}, {"B", "2"}}, "it");
    const std::string twice = image::with_png_text(once, {{"A", "3"}}, "it");
    EXPECT_EQ(image::png_text(twice, "it"), (TextLines{{"A", "3"}, {"B", "2"}}));
}

TEST(PngText, OnlyPrintableAsciiIsWritten) {
    const std::string with =
        image::with_png_text(picture(), {{"K\n", std::string("a\0b\xc3\xa9", 5)}}, "it");
    EXPECT_EQ(image::png_text(with, "it"), (TextLines{{"K?", "a?b??"}}));
}

TEST(PngText, ALineOfTenKilobytesComesBack) {
    const std::string lengthy(10'000, '%');
    const std::string with = image::with_png_text(picture(), {{"Note", lengthy}}, "it");
    EXPECT_EQ(image::png_text(with, "it"), (TextLines{{"Note", lengthy}}));
}

TEST(PngText, BadKeywordsAndFilesAreRefused) {
    EXPECT_THROW(image::with_png_text(picture(), {{"", "x"}}, "it"), Error);
    EXPECT_THROW(image::with_png_text(picture(), {{std::string(80, 'k'), "x"}}, "it"), Error);
    for (const std::string& bytes :
         {std::string(), std::string("\xff\xd8\xff"), picture().substr(0, 8),
          picture().substr(0, picture().size() - 1)})
        EXPECT_THROW(image::with_png_text(bytes, {{"A", "1"}}, "it"), Error);
}

TEST(PngText, BrokenFilesNeverCrash) {
    const std::string whole = image::with_png_text(picture(), {{"A", "1"}}, "it");
    for (size_t at = 0; at < whole.size(); ++at) {
        std::string broken = whole;
        broken[at] = static_cast<char>(broken[at] ^ 0x80);
        try {
            image::png_text(broken, "it");
            image::with_png_text(broken, {{"B", "2"}}, "it");
        } catch (const Error& error) {
            EXPECT_EQ(error.status, Status::BadFile);
        }
    }
}
