// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what is kept of what took long to find: it comes back, grows old, and a damaged file is
// empty.
#include "base/files.h"
#include "base/findings_file.h"
#include "scenes/damaged_files.h"
#include "scratch.h"

using namespace lodestone;

namespace {

constexpr std::string_view kTestVersion = "LDSTEST1";

/// A folder in which nothing is kept yet.
std::filesystem::path empty_place(const char* name) {
    std::filesystem::remove_all(own_scratch() / name);
    return own_scratch() / name;
}

}  // namespace

TEST(FindingsFile, NoFileKeepsNothing) {
    FindingsFile bakes{std::filesystem::path(), kTestVersion};
    EXPECT_FALSE(bakes.find(1));
    bakes.add(1, "one");
    EXPECT_EQ(bakes.find(1), "one");
    bakes.save();
    FindingsFile nowhere{empty_place("nothing") / "missing" / "file", kTestVersion};
    EXPECT_FALSE(nowhere.find(1));
}

TEST(FindingsFile, WhatWasAddedComesBack) {
    const std::filesystem::path file = empty_place("bakes") / "sky";
    FindingsFile first(file, kTestVersion);
    first.add(7, std::string("a\0b", 3));
    first.add(8, "");
    first.save();
    FindingsFile second(file, kTestVersion);
    EXPECT_EQ(second.find(7), std::string("a\0b", 3));
    EXPECT_EQ(second.find(8), "");
    EXPECT_FALSE(second.find(9));
}

TEST(FindingsFile, NothingNewWritesNothing) {
    const std::filesystem::path file = empty_place("bakes") / "sky";
    FindingsFile first(file, kTestVersion);
    first.add(7, "seven");
    first.save();
    std::filesystem::last_write_time(file, {});
    FindingsFile second(file, kTestVersion);
    second.find(7);
    second.save();
    EXPECT_EQ(std::filesystem::last_write_time(file), std::filesystem::file_time_type{});
}

TEST(FindingsFile, WhatNobodyAsksForIsLeftOutInTime) {
    const std::filesystem::path file = empty_place("bakes") / "sky";
    FindingsFile first(file, kTestVersion);
    first.add(1, "old");
    first.add(2, "used");
    first.save();
    for (Hash i = 0; i <= FindingsFile::kMostAge; ++i) {
        FindingsFile next(file, kTestVersion);
        EXPECT_TRUE(next.find(2));
        next.add(100 + i, "new");
        next.save();
    }
    FindingsFile last(file, kTestVersion);
    EXPECT_FALSE(last.find(1));
    EXPECT_EQ(last.find(2), "used");
}

TEST(FindingsFile, DamagedFilesAreEmpty) {
    const std::filesystem::path file = empty_place("bakes") / "sky";
    FindingsFile first(file, kTestVersion);
    for (Hash i = 0; i < 20; ++i)
        first.add(i, std::string(i, 'x'));
    first.save();
    const std::string bytes = read_file(file);
    PcgRandom random(5);
    for (int i = 0; i < 500; ++i) {
        const std::string other = hostile::mutated(bytes, random);
        write_file(file, other);
        FindingsFile bakes(file, kTestVersion);
        EXPECT_EQ(bakes.find(3).has_value(), other == bytes);
    }
}

TEST(FindingsFile, AnotherVersionIsEmpty) {
    const std::filesystem::path file = empty_place("findings") / "file";
    FindingsFile first(file, kTestVersion);
    first.add(7, "seven");
    first.save();
    EXPECT_FALSE(FindingsFile(file, "LDSTEST2").find(7));
    EXPECT_TRUE(FindingsFile(file, kTestVersion).find(7));
}
