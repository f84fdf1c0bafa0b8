// SPDX-License-Identifier: GPL-3.0-or-later
// Guards files that are kept: they come back whole or not at all, and do not fill the disk.
#include "base/files.h"
#include "base/findings_folder.h"
#include "scratch.h"

#include <chrono>

using namespace lodestone;
namespace fs = std::filesystem;

namespace {

fs::path absent_folder(const char* name) {
    fs::remove_all(own_scratch() / name);
    return own_scratch() / name;
}

size_t files_in(const fs::path& folder) {
    return static_cast<size_t>(
        std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

}  // namespace

TEST(FindingsFolder, NoFolderKeepsNothing) {
    FindingsFolder nowhere("", ".png");
    nowhere.add(1, "one");
    EXPECT_FALSE(nowhere.find(1));
    EXPECT_FALSE(FindingsFolder(absent_folder("nothing") / "missing", ".png").find(1));
}

TEST(FindingsFolder, WhatWasAddedComesBack) {
    const fs::path folder = absent_folder("kept") / "baked";
    const std::string bytes("a\0b", 3);
    {
        FindingsFolder first(folder, ".png");
        first.add(7, bytes);
        EXPECT_EQ(first.find(7), bytes);
    }
    FindingsFolder second(folder, ".png");
    EXPECT_EQ(second.find(7), bytes);
    EXPECT_FALSE(second.find(8));
    EXPECT_FALSE(FindingsFolder(folder, ".jpg").find(7));
}

TEST(FindingsFolder, DamagedFilesAreNotFoundAndReplaced) {
    const fs::path folder = absent_folder("damaged") / "baked";
    FindingsFolder(folder, ".png").add(7, "seven");
    const fs::path file = fs::directory_iterator(folder)->path();
    for (const char* other : {"seve", "sevem", "", "sevenseven"}) {
        write_file(file, other);
        FindingsFolder again(folder, ".png");
        EXPECT_FALSE(again.find(7)) << other;
        again.add(7, "seven");
        EXPECT_EQ(again.find(7), "seven");
        EXPECT_EQ(files_in(folder), 1u);
    }
    // What has no such name, or is no file, is left alone.
    write_file(folder / "0000000000000007-000000000000000.png", "seven");
    write_file(folder / "000000000000000x-0000000000000000.png", "seven");
    fs::create_directory(folder / "0000000000000008-0000000000000000.png");
    FindingsFolder again(folder, ".png");
    EXPECT_EQ(again.find(7), "seven");
    EXPECT_FALSE(again.find(8));
    EXPECT_FALSE(again.find(0));
    EXPECT_EQ(files_in(folder), 4u);
}

TEST(FindingsFolder, TheOldestAreRemovedWhereAllAreTooLarge) {
    const fs::path folder = absent_folder("many") / "baked";
    const std::string large(FindingsFolder::kMostBytes / 4, 'x');
    fs::create_directories(folder);
    write_file(folder / "picture.png", "not a finding");
    for (Hash key = 0; key < 6; ++key) {
        FindingsFolder one(folder, ".png");
        one.add(key, large);
        for (const fs::directory_entry& file : fs::directory_iterator(folder))
            fs::last_write_time(file, file.last_write_time() - std::chrono::hours(1));
        EXPECT_TRUE(one.find(0));  // that one is of use
    }
    FindingsFolder last(folder, ".png");
    EXPECT_TRUE(last.find(0));
    EXPECT_FALSE(last.find(1));
    EXPECT_TRUE(last.find(5));
    EXPECT_LE(files_in(folder), 5u);
    EXPECT_EQ(read_file(folder / "picture.png"), "not a finding");
    last.add(9, large + large + large + large + large);
    EXPECT_FALSE(last.find(9));
}
