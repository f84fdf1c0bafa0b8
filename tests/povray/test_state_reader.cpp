// SPDX-License-Identifier: GPL-3.0-or-later
// Guards reading what POV-Ray has drawn so far: known bytes, cut off anywhere, and hostile ones.
#include "povray_export/run/state_reader.h"

#include <bit>
#include <climits>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

using namespace lodestone;
using namespace lodestone::povray;

namespace {

std::string word(uint32_t value) {
    std::string out;
    for (const unsigned shift : {24U, 16U, 8U, 0U})
        out += static_cast<char>(value >> shift & 0xFFU);
    return out;
}

std::string number(float value) {
    return word(std::bit_cast<uint32_t>(value));
}

std::string head() {
    std::string out = "POV-Ray Render State File";
    out.resize(28);
    out += "0001";
    out.resize(512);
    return out;
}

/// An attribute; the type's first letter tells whether `length` counts numbers or bytes.
std::string attribute(const std::string& key, const std::string& type, uint32_t length,
                      const std::string& data) {
    return key + type + word(length) + data;
}

std::string whole_number(const std::string& key, int value) {
    return attribute(key, "INT4", 4, word(static_cast<uint32_t>(value)));
}

std::string message(const std::string& kind, uint32_t count, const std::string& attributes) {
    const std::string body = "OBJE" + word(count + 3) + attribute("OCLA", "TYPE", 4, "PixD") +
                             attribute("MIDE", "TYPE", 4, kind) +
                             attribute("MSRC", "ADDR", 10, "0123456789") + attributes;
    return "POVRAYMS" + word(0x370) + word(static_cast<uint32_t>(body.size())) + "RAWS" + body;
}

std::string color(float red, float green, float blue, float transmit) {
    return number(red) + number(green) + number(blue) + number(0) + number(transmit);
}

/// A finished rectangle whose red is the column and whose green is the row.
std::string block(int left, int top, int right, int bottom) {
    std::string colors;
    for (int y = top; y <= bottom; ++y) {
        for (int x = left; x <= right; ++x)
            colors += color(static_cast<float>(x), static_cast<float>(y), 0.25f, 0.5f);
    }
    return message("PxBS", 5,
                   attribute("PBlo", "VFL4", static_cast<uint32_t>(colors.size() / 4), colors) +
                       whole_number("Left", left) + whole_number("Top ", top) +
                       whole_number("Righ", right) + whole_number("Bott", bottom));
}

/// Two squares of a mosaic.
std::string squares(int side, int x0, int y0, int x1, int y1) {
    const auto at = [](int value) { return word(static_cast<uint32_t>(value)); };
    return message("PxSe", 3,
                   attribute("PPos", "VIN4", 4, at(x0) + at(y0) + at(x1) + at(y1)) +
                       attribute("PCol", "VFL4", 10, color(7, 0, 0, 0) + color(8, 0, 0, 1)) +
                       whole_number("PiSi", side));
}

std::vector<LivePixel> pixels_of(LivePicture& picture) {
    const auto [left, top, width, height] = picture.part();
    std::vector<LivePixel> out(picture.pixels());
    std::vector<LivePixel> room(picture.pixels() + 1024);
    while (const auto where = picture.take(false, room)) {
        for (int y = 0; y < where->height; ++y) {
            for (int x = 0; x < where->width; ++x)
                out.at((where->top + y) * width + where->left + x) = room.at(y * where->width + x);
        }
    }
    return out;
}

std::string known_file() {
    return head() + squares(32, 0, 0, 32, 0) + message("Else", 0, "") + squares(8, 8, 8, 40, 0) +
           block(0, 0, 31, 19) + block(32, 0, 39, 19);
}

}  // namespace

TEST(StateReader, KnownBytesAreThePictureHoweverTheyArrive) {
    const std::string file = known_file();
    for (const size_t step : {file.size(), size_t{1}, size_t{7}, size_t{4096}}) {
        LivePicture picture({0, 0, 40, 20});
        StateReader reader(picture);
        for (size_t at = 0; at < file.size(); at += step)
            reader.read(std::string_view(file).substr(at, step));
        EXPECT_FALSE(reader.broken());
        EXPECT_EQ(picture.finished(), 800u);
        const auto pixels = pixels_of(picture);
        EXPECT_EQ(pixels[0], (LivePixel{0, 0, 0.25f, 0.5f}));
        EXPECT_EQ(pixels[19 * 40 + 38], (LivePixel{38, 19, 0.25f, 0.5f}));
    }
}

TEST(StateReader, AMosaicComesBeforeWhatIsFinished) {
    LivePicture picture({0, 0, 40, 20});
    StateReader reader(picture);
    reader.read(head() + squares(32, 0, 0, 32, 0) + squares(8, 8, 8, 32, 8));
    EXPECT_EQ(picture.finished(), 0u);
    const auto pixels = pixels_of(picture);
    EXPECT_EQ(pixels[0], (LivePixel{7, 0, 0, 1}));
    EXPECT_EQ(pixels[39], (LivePixel{8, 0, 0, 0}));
    EXPECT_EQ(pixels[8 * 40 + 8], (LivePixel{7, 0, 0, 1}));
}

TEST(StateReader, AFileThatIsCutOffGivesWhatIsWhole) {
    const std::string file = known_file();
    const std::string last = block(32, 0, 39, 19);
    const size_t before = file.size() - last.size();  // where the first block ends
    for (size_t size = 0; size <= file.size(); size += size < 2000 ? 1 : 97) {
        LivePicture picture({0, 0, 40, 20});
        StateReader reader(picture);
        reader.read(std::string_view(file).substr(0, size));
        EXPECT_FALSE(reader.broken()) << size;
        EXPECT_EQ(picture.finished(), size == file.size() ? 800u
                                      : size >= before    ? 640u
                                                          : 0u)
            << size;
        // The rest makes it whole, whenever it comes.
        reader.read(std::string_view(file).substr(size));
        EXPECT_EQ(picture.finished(), 800u) << size;
    }
}

TEST(StateReader, AnotherFileIsNotReadOn) {
    for (const std::string& wrong :
         {std::string("\x76\x2f\x31\x01 an EXR"), std::string(600, '\0'),
          head() + std::string(600, 'x'),
          head() + "POVRAYMS" + word(0x370) + word(0xFFFFFFFF) + "RAWS",
          head() + "POVRAYMS" + word(0x370) + word(20) + "WARS" + std::string(20, ' ')}) {
        LivePicture picture({0, 0, 40, 20});
        StateReader reader(picture);
        reader.read(wrong);
        EXPECT_TRUE(reader.broken());
        reader.read(known_file());
        EXPECT_TRUE(reader.broken());
        EXPECT_EQ(picture.finished(), 0u);
    }
}

TEST(StateReader, HostileSizesDrawNothing) {
    LivePicture picture({0, 0, 40, 20});
    StateReader reader(picture);
    const std::string one = attribute("PBlo", "VFL4", 5, color(1, 1, 1, 0));
    const auto corners = [](int left, int top, int right, int bottom) {
        return whole_number("Left", left) + whole_number("Top ", top) +
               whole_number("Righ", right) + whole_number("Bott", bottom);
    };
    reader.read(head());
    reader.read(message("PxBS", 5, one + corners(0, 0, 1, 0)));  // one color for two pixels
    reader.read(message("PxBS", 5, one + corners(INT_MIN, INT_MIN, INT_MAX, INT_MAX)));
    reader.read(message("PxBS", 5, one + corners(5, 5, 4, 4)));
    reader.read(message("PxBS", 5, one + corners(INT_MAX, 0, INT_MIN, 0)));
    reader.read(message("PxBS", 5, attribute("PBlo", "VFL4", 0, "") + corners(0, 0, -1, -1)));
    reader.read(message(
        "PxBS", 5,
        attribute("PBlo", "VFL4", 4, word(0) + word(0) + word(0) + word(0)) + corners(0, 0, 0, 0)));
    reader.read(message("PxBS", 0xFFFFFFF0U, one + corners(0, 0, 0, 0)));  // more attributes
    reader.read(message("PxBS", 1, attribute("PBlo", "VFL4", 0x40000001U, "abcd")));
    reader.read(message("PxBS", 1, attribute("PBlo", "TYPE", 0xFFFFFFFFU, "abcd")));
    reader.read(message("PxBS", 1, "PBl"));
    reader.read(message("PxSe", 0, ""));
    reader.read(squares(0, 0, 0, 8, 8));
    reader.read(squares(-8, 0, 0, 8, 8));
    reader.read(message("PxSe", 3,
                        attribute("PPos", "VIN4", 3, word(0) + word(0) + word(0)) +
                            attribute("PCol", "VFL4", 5, color(1, 1, 1, 0)) +
                            whole_number("PiSi", 8)));
    EXPECT_FALSE(reader.broken());
    EXPECT_EQ(picture.finished(), 0u);
    std::vector<LivePixel> room(1024);
    EXPECT_FALSE(picture.take(false, room));
    reader.read(block(0, 0, 31, 19));  // and what follows is read
    EXPECT_EQ(picture.finished(), 640u);
}

// A file of small messages that each paint all of a large picture kept a call busy without end.
TEST(StateReader, ACallPaintsAFewMillionPixelsAndTheRestWaits) {
    LivePicture picture({0, 0, 1024, 1024});
    StateReader reader(picture);
    const std::string all = squares(1024, 0, 0, 0, 0);
    std::string many = head();
    for (int i = 0; i < 40; ++i)
        many += all;
    reader.read(many);
    EXPECT_TRUE(reader.behind());
    int calls = 1;
    for (; reader.behind() && calls < 100; ++calls)
        reader.read({});
    EXPECT_FALSE(reader.behind());
    EXPECT_GE(calls, 10);
    EXPECT_LE(calls, 40);
    reader.read(block(0, 0, 31, 19));
    EXPECT_EQ(picture.finished(), 640u);
}

TEST(StateReader, ASquareLargerThanAnyMosaicsDrawsNothing) {
    LivePicture picture({0, 0, 40, 20});
    StateReader reader(picture);
    reader.read(head() + squares(1025, 0, 0, 8, 8) + squares(INT_MAX, 0, 0, 8, 8));
    std::vector<LivePixel> room(1024);
    EXPECT_FALSE(picture.take(false, room));
    EXPECT_FALSE(reader.broken());
}

TEST(StateReader, NumbersThatAreNoneAreBlack) {
    LivePicture picture({0, 0, 2, 1});
    StateReader reader(picture);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float endless = std::numeric_limits<float>::infinity();
    const std::string colors = color(nan, endless, 2, nan) + color(-1, 3, 4, -5);
    reader.read(head() + message("PxBS", 5,
                                 attribute("PBlo", "VFL4", 10, colors) + whole_number("Left", 0) +
                                     whole_number("Top ", 0) + whole_number("Righ", 1) +
                                     whole_number("Bott", 0)));
    const auto pixels = pixels_of(picture);
    EXPECT_EQ(pixels[0], (LivePixel{0, 0, 2, 1}));
    EXPECT_EQ(pixels[1], (LivePixel{-1, 3, 4, 1}));
}

TEST(StateReader, SquaresLargerThanThePictureEndSoon) {
    LivePicture picture({0, 0, 512, 512});
    StateReader reader(picture);
    std::string positions;
    std::string colors;
    constexpr uint32_t kCount = 30000;
    for (uint32_t i = 0; i < kCount; ++i) {
        positions += word(0) + word(0);
        colors += color(1, 1, 1, 0);
    }
    reader.read(head() + message("PxSe", 3,
                                 attribute("PPos", "VIN4", 2 * kCount, positions) +
                                     attribute("PCol", "VFL4", 5 * kCount, colors) +
                                     whole_number("PiSi", 1024)));
    EXPECT_FALSE(reader.broken());
    EXPECT_EQ(pixels_of(picture).back(), (LivePixel{1, 1, 1, 1}));
}

TEST(StateReader, DamagedBytesNeverDrawOutside) {
    std::mt19937 random(1);
    const std::string file = known_file();
    for (int round = 0; round < 400; ++round) {
        std::string damaged = file;
        for (int i = 0; i < 12; ++i)
            damaged[512 + random() % (damaged.size() - 512)] = static_cast<char>(random());
        LivePicture picture({0, 0, 40, 20});
        StateReader reader(picture);
        reader.read(damaged);
        EXPECT_LE(picture.finished(), picture.pixels());
        EXPECT_EQ(pixels_of(picture).size(), 800u);
    }
}
