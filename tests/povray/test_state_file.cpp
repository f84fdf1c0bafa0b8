// SPDX-License-Identifier: GPL-3.0-or-later
// Guards following a file that grows: it may be missing, half written, or no file at all.
#include "povray_export/run/state_file.h"
#include "scratch.h"

#include <chrono>
#include <fstream>
#include <gtest/gtest.h>
#include <sys/stat.h>

using namespace lodestone;
using namespace lodestone::povray;

namespace {

/// A head, and a message that paints one square of the given color.
std::string painted(bool with_head, char red) {
    std::string out;
    if (with_head) {
        out = "POV-Ray Render State File";
        out.resize(512);
    }
    const std::string body =
        std::string(
            "OBJE\0\0\0\4MIDETYPE\0\0\0\4PxSePPosVIN4\0\0\0\2\0\0\0\0\0\0\0\0PiSiINT4\0\0\0"
            "\4\0\0\0\4PColVFL4\0\0\0\5\x40",
            73) +
        red + std::string(18, '\0');
    out += std::string("POVRAYMS\0\0\3\x70\0\0\0", 15) + static_cast<char>(body.size()) + "RAWS";
    return out + body;
}

float red_of(LivePicture& picture) {
    std::vector<LivePixel> room(1024);
    return picture.take(false, room) ? room[0][0] : -1;
}

}  // namespace

TEST(StateFile, IsReadAsItGrows) {
    const auto folder = scratch("state_file");
    std::filesystem::create_directories(folder);
    const auto path = folder / "part.pov-state";
    LivePicture picture({0, 0, 4, 4});
    StateFile file(path, picture);
    EXPECT_FALSE(file.read_some());  // there is none
    EXPECT_EQ(red_of(picture), -1);
    std::ofstream out(path, std::ios::binary);
    const std::string first = painted(true, 0);
    out.write(first.data(), 600).flush();
    file.read_some();
    EXPECT_EQ(red_of(picture), -1);
    out.write(first.data() + 600, static_cast<std::streamsize>(first.size()) - 600).flush();
    file.read_some();
    EXPECT_EQ(red_of(picture), 2);
    out << painted(false, '\x40') << std::flush;
    std::filesystem::remove(path);  // as POV-Ray does in the end; what it wrote can still be read
    file.read_rest();
    EXPECT_EQ(red_of(picture), 3);
    EXPECT_FALSE(file.broken());
}

// The rest of a file was read for as long as that took.
TEST(StateFile, AFileWithoutAnEndIsNotReadToIt) {
    const auto folder = scratch("state_endless");
    std::filesystem::create_directories(folder);
    LivePicture picture({0, 0, 2048, 2048});
    std::string large = painted(false, '\x40');
    large.replace(large.find("PiSiINT4") + 12, 4, std::string("\0\0\4\0", 4));  // a side of 1,024
    std::string piece = painted(true, 0);
    for (int i = 0; i < 20000; ++i)
        piece += large;
    std::ofstream(folder / "part.pov-state", std::ios::binary) << piece;
    StateFile file(folder / "part.pov-state", picture);
    const auto start = std::chrono::steady_clock::now();
    EXPECT_TRUE(file.read_some());
    EXPECT_EQ(red_of(picture), 3);
    file.read_rest();
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
    EXPECT_FALSE(file.broken());
}

TEST(StateFile, WhatIsNoFileIsNotWaitedFor) {
    const auto folder = scratch("state_pipe");
    std::filesystem::create_directories(folder);
    ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
    std::ofstream(folder / "other") << std::string(600, 'x');
    std::filesystem::create_symlink("other", folder / "link");
    LivePicture picture({0, 0, 4, 4});
    for (const char* name : {"pipe", "link", "", "none"}) {
        StateFile file(folder / name, picture);
        file.read_rest();
        EXPECT_FALSE(file.broken()) << name;
        EXPECT_EQ(red_of(picture), -1) << name;
    }
    StateFile other(folder / "other", picture);
    other.read_rest();
    EXPECT_TRUE(other.broken());
}
