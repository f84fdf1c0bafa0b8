// SPDX-License-Identifier: GPL-3.0-or-later
// Guards reading and writing of pictures: every layout gives the same floats, no file can crash us.
#include "base/error.h"
#include "base/files.h"
#include "image/image.h"
#include "image/picture_size.h"
#include "scenes/damaged_files.h"
#include "scenes/picture_files.h"
#include "scratch.h"

#include <jpeglib.h>
#include <png.h>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <array>
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <limits>
#include <numeric>
#include <zlib.h>

namespace lodestone::image {
namespace {

using pictures::exr;
using pictures::jpeg;
using pictures::png;

std::filesystem::path scratch(const std::string& name) {
    return own_scratch() / name;
}

std::string complaint(const std::string& bytes) {
    try {
        read(bytes, "the file");
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

const float* pixel(const Image& image, int x, int y) {
    return image.pixels.data() + ptrdiff_t{4} * (ptrdiff_t{y} * image.width + x);
}

void expect_pixel(const Image& image, int x, int y, std::array<float, 4> expected) {
    for (size_t c = 0; c < 4; ++c)
        EXPECT_NEAR(pixel(image, x, y)[c], expected[c], 1e-6f) << x << ' ' << y << ' ' << c;
}

TEST(Image, EmptyAndForeignFilesAreRefusedByName) {
    EXPECT_NE(complaint("").find("'the file' is not a PNG"), std::string::npos);
    EXPECT_NE(complaint("GIF89a").find("not a PNG"), std::string::npos);
    EXPECT_THROW(read(scratch("nowhere.png")), Error);
}

TEST(Image, OnePixelSurvivesPng) {
    Image image;
    image.width = image.height = 1;
    image.pixels = {1, 0.2f, 0.4f, 0.6f};
    write_png(scratch("one.png"), image);
    const Image back = read(scratch("one.png"));
    EXPECT_FALSE(back.linear);
    expect_pixel(back, 0, 0, {1, 0.2f, 0.4f, 0.6f});
}

TEST(Image, PngGrayOfEveryDepth) {
    // Two pixels, darkest and brightest but one.
    expect_pixel(read(png(2, 1, 1, PNG_COLOR_TYPE_GRAY, {0x40}), "1"), 1, 0, {1, 1, 1, 1});
    const float third = 2.0f / 3;
    expect_pixel(read(png(2, 1, 2, PNG_COLOR_TYPE_GRAY, {0x20}), "2"), 1, 0,
                 {third, third, third, 1});
    expect_pixel(read(png(2, 1, 4, PNG_COLOR_TYPE_GRAY, {0x03}), "4"), 1, 0, {0.2f, 0.2f, 0.2f, 1});
    expect_pixel(read(png(2, 1, 8, PNG_COLOR_TYPE_GRAY, {0, 51}), "8"), 1, 0,
                 {0.2f, 0.2f, 0.2f, 1});
    const float wide = 0x1234 / 65535.0f;
    expect_pixel(read(png(1, 1, 16, PNG_COLOR_TYPE_GRAY, {0x12, 0x34}), "16"), 0, 0,
                 {wide, wide, wide, 1});
    expect_pixel(read(png(1, 1, 16, PNG_COLOR_TYPE_GRAY_ALPHA, {0x12, 0x34, 0x80, 0}), "16a"), 0, 0,
                 {wide, wide, wide, 0x8000 / 65535.0f});
}

TEST(Image, PngColorPaletteAndInterlace) {
    expect_pixel(read(png(1, 1, 8, PNG_COLOR_TYPE_RGB, {51, 102, 255}), "rgb"), 0, 0,
                 {0.2f, 0.4f, 1, 1});
    expect_pixel(read(png(1, 1, 8, PNG_COLOR_TYPE_RGB_ALPHA, {51, 102, 255, 51}), "rgba"), 0, 0,
                 {0.2f, 0.4f, 1, 0.2f});
    expect_pixel(
        read(png(1, 1, 16, PNG_COLOR_TYPE_RGB_ALPHA, {0xff, 0xff, 0, 0, 0, 1, 0xff, 0xff}), "16"),
        0, 0, {1, 0, 1 / 65535.0f, 1});
    const Image palette = read(
        png(2, 1, 1, PNG_COLOR_TYPE_PALETTE, {0x40}, false, {{0, 0, 0}, {255, 51, 0}}, {255, 102}),
        "palette");
    expect_pixel(palette, 0, 0, {0, 0, 0, 1});
    expect_pixel(palette, 1, 0, {1, 0.2f, 0, 0.4f});
    std::vector<unsigned char> rows(size_t{9} * 9);
    for (size_t i = 0; i < rows.size(); ++i)
        rows[i] = static_cast<unsigned char>(3 * i);
    const Image plain = read(png(9, 9, 8, PNG_COLOR_TYPE_GRAY, rows), "plain");
    const Image interlaced = read(png(9, 9, 8, PNG_COLOR_TYPE_GRAY, rows, true), "interlaced");
    EXPECT_EQ(plain.pixels, interlaced.pixels);
    expect_pixel(plain, 1, 2, {57 / 255.0f, 57 / 255.0f, 57 / 255.0f, 1});  // top row first
}

TEST(Image, AllEightBitValuesSurviveWritingAndReading) {
    Image image;
    image.width = 256;
    image.height = 2;
    for (int i = 0; i < 512; ++i) {
        const float value = static_cast<float>(i % 256) / 255.0f;
        image.pixels.insert(image.pixels.end(), {value, 1 - value, 0, i < 256 ? 1.0f : value});
    }
    write_png(scratch("all.png"), image);
    const Image back = read(scratch("all.png"));
    ASSERT_EQ(back.pixels.size(), image.pixels.size());
    for (size_t i = 0; i < back.pixels.size(); ++i)
        ASSERT_NEAR(back.pixels[i], image.pixels[i], 1e-6f) << i;
}

TEST(Image, TheHeaderTellsTheSize) {
    const auto size_of = [](const std::string& bytes) {
        write_file(scratch("header"), bytes);
        return picture_size(scratch("header"));
    };
    for (const std::string& bytes :
         {png(9, 5, 8, PNG_COLOR_TYPE_GRAY, std::vector<unsigned char>(45)),
          jpeg(9, 5, 1, JCS_GRAYSCALE, 128), jpeg(9, 5, 3, JCS_RGB, 51)}) {
        const auto size = size_of(bytes);
        ASSERT_TRUE(size);
        EXPECT_EQ(size->width, 9u);
        EXPECT_EQ(size->height, 5u);
        EXPECT_EQ(size->texels(), 45u);
        for (const size_t cut : {0, 4, 20})
            EXPECT_FALSE(size_of(bytes.substr(0, cut))) << cut;
    }
    EXPECT_FALSE(size_of("text"));
    EXPECT_FALSE(picture_size(scratch("none.png")));
    std::string vast = jpeg(9, 5, 1, JCS_GRAYSCALE, 128);
    const size_t frame = vast.find("\xff\xc0");  // of baseline JPEG: length, bits, height, width
    ASSERT_NE(frame, std::string::npos);
    vast.replace(frame + 5, 4, 4, '\xfd');
    EXPECT_FALSE(size_of(vast)) << "64,000 x 64,000 pixels";
}

TEST(Image, JpegGrayAndColor) {
    const Image gray = read(jpeg(9, 5, 1, JCS_GRAYSCALE, 128), "gray");
    EXPECT_EQ(gray.width, 9);
    EXPECT_EQ(gray.height, 5);
    EXPECT_NEAR(pixel(gray, 8, 4)[0], 128 / 255.0f, 0.01f);
    const Image color = read(jpeg(9, 5, 3, JCS_RGB, 51), "color");
    EXPECT_NEAR(pixel(color, 4, 2)[0], 1, 0.02f);
    EXPECT_NEAR(pixel(color, 4, 2)[1], 0.2f, 0.02f);
    EXPECT_EQ(pixel(color, 4, 2)[3], 1);
}

TEST(Image, JpegOfPrintersAndTornOnesAreRefused) {
    EXPECT_NE(complaint(jpeg(8, 8, 4, JCS_CMYK, 10)).find("CMYK"), std::string::npos);
    const std::string whole = jpeg(64, 64, 3, JCS_RGB, 51);
    EXPECT_NE(complaint(whole.substr(0, whole.size() * 2 / 3)).find("broken JPEG"),
              std::string::npos);
}

TEST(Image, ExrIsLinearWithItsOwnAlpha) {
    const Imath::Box2i window({0, 0}, {3, 2});
    const Image image = read(exr("RGBA", window, window), "exr");
    EXPECT_TRUE(image.linear);
    EXPECT_EQ(image.width, 4);
    EXPECT_EQ(image.height, 3);
    expect_pixel(image, 3, 1, {13, 113, 213, 313});
    expect_pixel(read(exr("RGB", window, window), "rgb"), 2, 2, {22, 122, 222, 1});
    expect_pixel(read(exr("Y", window, window), "gray"), 2, 2, {22, 22, 22, 1});
    EXPECT_NE(complaint(exr("Z", window, window)).find("neither"), std::string::npos);
}

TEST(Image, ExrsThatWeWriteAreReadAgain) {
    Image image;
    image.width = 3;
    image.height = 2;
    image.linear = true;
    for (int i = 0; i < 24; ++i)
        image.pixels.push_back(static_cast<float>(i) / 8);
    image.pixels[4] = 1e9f;
    const Image again = read(exr_bytes(image), "written");
    EXPECT_TRUE(again.linear);
    EXPECT_EQ(again.width, 3);
    EXPECT_EQ(again.height, 2);
    image.pixels[4] = 65504;
    EXPECT_EQ(again.pixels, image.pixels);
    image.linear = false;
    EXPECT_THROW(exr_bytes(image), Error);
    image.linear = true;
    image.pixels.pop_back();
    EXPECT_THROW(exr_bytes(image), Error);
}

TEST(Image, ExrDataWindowIsPlacedInTheDisplayWindow) {
    const Image image =
        read(exr("RGBA", Imath::Box2i({-1, 2}, {1, 9}), Imath::Box2i({0, 1}, {3, 4})), "exr");
    EXPECT_EQ(image.width, 4);
    EXPECT_EQ(image.height, 4);
    expect_pixel(image, 0, 0, {0, 0, 0, 0});  // above the data
    expect_pixel(image, 0, 1, {1, 101, 201, 301});
    expect_pixel(image, 1, 3, {22, 122, 222, 322});
    expect_pixel(image, 2, 1, {0, 0, 0, 0});  // right of it
}

TEST(Image, APartOfAnExrIsThatOfTheWhole) {
    // Two blocks of rows, and a display window that reaches beyond the data on all sides
    const std::string bytes =
        exr("RGBA", Imath::Box2i({-1, 2}, {6, 300}), Imath::Box2i({-3, 0}, {8, 310}));
    const std::filesystem::path path = scratch("parts.exr");
    write_file(path, bytes);
    const Image whole = read(path);
    for (const ImageRegion& part :
         {ImageRegion{0, 0, 12, 311}, ImageRegion{3, 255, 5, 9}, ImageRegion{0, 0, 2, 1},
          ImageRegion{11, 310, 1, 1}, ImageRegion{1, 1, 3, 2}}) {
        const Image found = read_region(path, part);
        ASSERT_EQ(found.width, part.width);
        ASSERT_EQ(found.height, part.height);
        for (int y = 0; y < part.height; ++y) {
            for (int x = 0; x < part.width; ++x) {
                for (int c = 0; c < 4; ++c)
                    ASSERT_EQ(pixel(found, x, y)[c], pixel(whole, part.left + x, part.top + y)[c]);
            }
        }
    }
    constexpr int kMost = std::numeric_limits<int>::max();
    for (const ImageRegion& part :
         {ImageRegion{-1, 0, 1, 1}, ImageRegion{0, 0, 13, 1}, ImageRegion{0, 311, 1, 1},
          ImageRegion{0, 0, 0, 1}, ImageRegion{kMost, 0, kMost, 1}})
        EXPECT_THROW(read_region(path, part), Error);
    std::filesystem::remove(path);
}

TEST(Image, ABorderOfAPosterIsReadThoughThePosterIsTooLarge) {
    const Imath::Box2i window({0, 0}, {9999, 9999});
    const std::filesystem::path path = scratch("poster.exr");
    {
        Imf::Header header(window, window);
        header.compression() = Imf::ZIP_COMPRESSION;
        std::vector<float> row(10000);
        std::iota(row.begin(), row.end(), 0.0f);
        Imf::FrameBuffer buffer;
        header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
        buffer.insert("Y", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(row.data()), 4, 0));
        Imf::OutputFile file(path.c_str(), header, 0);
        file.setFrameBuffer(buffer);
        file.writePixels(32);  // the others are missing, which a part above them does not meet
    }
    EXPECT_NE(complaint(read_file(path)).find("too large"), std::string::npos);
    expect_pixel(read_region(path, {9998, 20, 2, 1}), 1, 0, {9999, 9999, 9999, 1});
    EXPECT_THROW(read_region(path, {0, 20, 1, 80}), Error);
    std::filesystem::remove(path);
}

TEST(Image, EncodingUnassociatesAlphaAndClamps) {
    Image image;
    image.width = 4;
    image.height = 1;
    image.linear = true;
    image.pixels = {0.10702057f,   0,  2,        0.5f, 1, 1, 1, 0,
                    std::nanf(""), -1, INFINITY, 2,    1, 1, 1, std::nanf("")};
    const Image display = encoded(image);
    EXPECT_FALSE(display.linear);
    expect_pixel(display, 0, 0, {0.5f, 0, 1, 0.5f});
    expect_pixel(display, 1, 0, {1, 1, 1, 0});
    expect_pixel(display, 2, 0, {0, 0, 1, 1});
    expect_pixel(display, 3, 0, {1, 1, 1, 0});
    EXPECT_EQ(encoded(display).pixels, display.pixels);
}

TEST(Image, HeadersThatPromiseTooMuchAreRefusedBeforeMemoryIsSpent) {
    std::string huge = png(8, 8, 8, PNG_COLOR_TYPE_GRAY, std::vector<unsigned char>(64));
    const auto patch = [&](unsigned width, unsigned height) {
        const std::array<unsigned, 2> sizes{width, height};
        for (size_t k = 0; k < 8; ++k)
            huge[16 + k] = static_cast<char>(sizes[k / 4] >> (24 - 8 * (k % 4)));
        const unsigned long crc = crc32(0, reinterpret_cast<const Bytef*>(huge.data() + 12), 17);
        for (size_t k = 0; k < 4; ++k)
            huge[29 + k] = static_cast<char>(crc >> (24 - 8 * k));
    };
    patch(8192, 8192);
    EXPECT_NE(complaint(huge).find("too short"), std::string::npos) << complaint(huge);
    patch(0x7fffffff, 0x7fffffff);
    EXPECT_FALSE(complaint(huge).empty());
    const Imath::Box2i window({0, 0}, {3, 2});
    std::string vast = exr("RGBA", window, window);
    const size_t at = vast.find("dataWindow");
    ASSERT_NE(at, std::string::npos);
    const int32_t far = 0x7ffffff0;
    std::memcpy(vast.data() + at + 11 + 6 + 4 + 8, &far, 4);
    EXPECT_NE(complaint(vast).find("too large"), std::string::npos) << complaint(vast);
}

TEST(Image, AnExrThatHidesASecondSizeInAnotherAttributeIsRefused) {
    // OpenEXR takes an int for four bytes long whatever its size says, and what follows for more of
    // the header: a window a hundred times as wide as the memory that we would have made for it.
    const Imath::Box2i window({0, 0}, {3, 2});
    std::string bytes = exr("R", window, window);
    const auto number = [](int32_t value) {
        return std::string(reinterpret_cast<const char*>(&value), sizeof value);
    };
    const std::string wide = std::string("dataWindow\0box2i\0", 17) + number(16) + number(0) +
                             number(0) + number(399) + number(2);
    const std::string inner = number(7) + wide;
    const std::string hiding =
        std::string("dx\0int\0", 7) + number(static_cast<int32_t>(inner.size())) + inner;
    const size_t at = bytes.find("displayWindow");
    ASSERT_NE(at, std::string::npos);
    bytes.insert(at, hiding);
    EXPECT_NE(complaint(bytes).find("two things"), std::string::npos) << complaint(bytes);
}

/// Gray, 16 x 16, progressive: a first scan, then `scans` of two bytes each that change nothing.
std::string scans_of_nothing(int scans) {
    const auto segment = [](int marker, const std::string& content) {
        const size_t size = content.size() + 2;
        return std::string{'\xff', static_cast<char>(marker), static_cast<char>(size >> 8u),
                           static_cast<char>(size & 0xffu)} +
               content;
    };
    const auto table = [&](int kind, int symbol) {  // one symbol, of the code 0
        return segment(0xc4, std::string(1, static_cast<char>(kind)) + '\1' +
                                 std::string(15, '\0') + static_cast<char>(symbol));
    };
    const auto scan = [&](int first, int last, const std::string& bits) {
        return segment(0xda, {1, 1, 0, static_cast<char>(first), static_cast<char>(last), 0}) +
               bits;
    };
    std::string out = "\xff\xd8" + segment(0xdb, std::string(1, '\0') + std::string(64, '\1')) +
                      segment(0xc2, {8, 0, 16, 0, 16, 1, 1, 0x11, 0}) + table(0x00, 0) +
                      table(0x10, 0x20) + scan(0, 0, "\x0f");
    for (int i = 0; i < scans; ++i)
        out += scan(1, 1, "\x1f");  // the end of this block and of the three after it
    return out + "\xff\xd9";
}

TEST(Image, AJpegOfThousandsOfEmptyScansIsRefused) {
    EXPECT_EQ(complaint(scans_of_nothing(8)), "");
    EXPECT_NE(complaint(scans_of_nothing(5000)).find("more than 500 scans"), std::string::npos)
        << complaint(scans_of_nothing(5000));
}

TEST(Image, WritingRefusesWhatIsNoImage) {
    Image image;
    EXPECT_THROW(write_png(scratch("none.png"), image), Error);
    image.width = 2;
    image.height = 2;
    image.pixels.resize(15);
    EXPECT_THROW(write_png(scratch("none.png"), image), Error);
    image.pixels.resize(16);
    EXPECT_THROW(write_png(scratch("no/such/folder.png"), image), Error);
    EXPECT_FALSE(std::filesystem::exists(scratch("none.png")));
}

TEST(Image, DamagedFilesNeverCrash) {
    const auto read_it = [](const std::string& bytes) { read(bytes, "damaged"); };
    std::vector<unsigned char> rows(size_t{24} * 16 * 4);
    for (size_t i = 0; i < rows.size(); ++i)
        rows[i] = static_cast<unsigned char>(i * 7);
    const int accepted =
        hostile::survive(png(24, 16, 8, PNG_COLOR_TYPE_RGB_ALPHA, rows, true), 300, read_it);
    EXPECT_LT(accepted, 150);
    hostile::survive(jpeg(24, 16, 3, JCS_RGB, 77), 300, read_it);
    const Imath::Box2i window({0, 0}, {11, 7});
    hostile::survive(exr("RGBA", window, window), 300, read_it);
}

}  // namespace
}  // namespace lodestone::image
