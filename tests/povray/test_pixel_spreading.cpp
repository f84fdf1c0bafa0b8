// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the blurring of finished pictures: in linear light, within what was drawn, never of posters.
#include "base/color.h"
#include "base/error.h"
#include "base/files.h"
#include "image/image.h"
#include "povray_export/run/pixel_spreading.h"
#include "scratch.h"

#include <fstream>
#include <gtest/gtest.h>

namespace lodestone::povray {
namespace {

/// A picture of linear light whose right half is white.
image::Image half_white(int width, int height) {
    image::Image image;
    image.width = width;
    image.height = height;
    image.linear = true;
    for (int i = 0; i < width * height; ++i) {
        const float value = i % width < width / 2 ? 0.0f : 1.0f;
        image.pixels.insert(image.pixels.end(), {value, value, value, 1.0f});
    }
    return image;
}

float red(const image::Image& image, int x, int y) {
    return image.pixels[4 * static_cast<size_t>(y * image.width + x)];
}

class PixelSpreading : public testing::Test {
protected:
    PixelSpreading() { std::filesystem::create_directories(folder_); }

    /// The picture after it was blurred by 0.1 square pixels.
    image::Image spread(OutputFormat format, const std::string& bytes,
                        const std::string& more_settings = "") {
        std::ofstream(settings_) << "Input_File_Name=scene.pov\nWidth=8\nHeight=4\n"
                                 << more_settings;
        write_file(picture_, bytes);
        spread_picture(picture_, format, 0.1, settings_);
        return image::read(picture_);
    }

    std::filesystem::path folder_ = own_scratch();
    std::filesystem::path picture_ = folder_ / "picture";
    std::filesystem::path settings_ = folder_ / "scene.ini";
};

TEST_F(PixelSpreading, NothingIsDoneWithoutAVariance) {
    write_file(picture_, "no picture");
    spread_picture(picture_, OutputFormat::Exr, 0, settings_);
    spread_picture(picture_, OutputFormat::Ppm, 0.1, settings_);
    EXPECT_EQ(read_file(picture_), "no picture");
}

TEST_F(PixelSpreading, AnEdgeGivesItsPartToBothSides) {
    const image::Image image = half_white(8, 4);
    const image::Image exr = spread(OutputFormat::Exr, image::exr_bytes(image));
    const image::Image png = spread(OutputFormat::Png, image::png_bytes(image));
    const float expected[8] = {0, 0, 0, 0.05f, 0.95f, 1, 1, 1};
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 8; ++x) {
            EXPECT_NEAR(red(exr, x, y), expected[x], 1e-3) << x;
            EXPECT_NEAR(decode_srgb(red(png, x, y)), expected[x], 1e-2) << x;
        }
    }
}

TEST_F(PixelSpreading, ABorderIsBlurredWithinItself) {
    image::Image image = half_white(8, 4);
    const image::Image part = spread(OutputFormat::Exr, image::exr_bytes(image),
                                     "Start_Column=5\nEnd_Column=7\nStart_Row=2\nEnd_Row=3\n");
    for (int x = 0; x < 8; ++x)
        EXPECT_NEAR(red(part, x, 1), x < 4 ? 0 : 1, 1e-3) << x;
}

TEST_F(PixelSpreading, WhatIsNoPictureIsPovraysFailure) {
    try {
        spread(OutputFormat::Exr, "nonsense");
        FAIL() << "it was read";
    } catch (const Error& error) {
        EXPECT_EQ(error.status, Status::PovrayFailed);
        EXPECT_NE(std::string(error.what()).find("picture cannot be read"), std::string::npos);
    }
}

TEST_F(PixelSpreading, PostersWereRefused) {
    std::ofstream(settings_) << "Input_File_Name=scene.pov\nWidth=20000\nHeight=20000\n";
    write_file(picture_, "a poster");
    spread_picture(picture_, OutputFormat::Exr, 0.1, settings_);
    EXPECT_EQ(read_file(picture_), "a poster");  // nobody tried to read so much
}

}  // namespace
}  // namespace lodestone::povray
