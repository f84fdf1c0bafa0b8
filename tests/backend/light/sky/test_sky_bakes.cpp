// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what is kept of the sky's light: it comes back, grows old, and a damaged file is empty.
#include "base/files.h"
#include "light/sky/sky_bakes.h"
#include "scenes/damaged_files.h"
#include "scratch.h"

using namespace lodestone;
using namespace lodestone::light;

TEST(SkyBakes, NoFileKeepsNothing) {
    SkyBakes bakes{std::filesystem::path()};
    EXPECT_FALSE(bakes.find(1));
    bakes.add(1, "one");
    EXPECT_EQ(bakes.find(1), "one");
    bakes.save();
    SkyBakes nowhere{scratch("nothing") / "missing" / "file"};
    EXPECT_FALSE(nowhere.find(1));
}

TEST(SkyBakes, WhatWasAddedComesBack) {
    const std::filesystem::path file = scratch("bakes") / "sky";
    SkyBakes first(file);
    first.add(7, std::string("a\0b", 3));
    first.add(8, "");
    first.save();
    SkyBakes second(file);
    EXPECT_EQ(second.find(7), std::string_view("a\0b", 3));
    EXPECT_EQ(second.find(8), "");
    EXPECT_FALSE(second.find(9));
}

TEST(SkyBakes, NothingNewWritesNothing) {
    const std::filesystem::path file = scratch("bakes") / "sky";
    SkyBakes first(file);
    first.add(7, "seven");
    first.save();
    std::filesystem::last_write_time(file, {});
    SkyBakes second(file);
    second.find(7);
    second.save();
    EXPECT_EQ(std::filesystem::last_write_time(file), std::filesystem::file_time_type{});
}

TEST(SkyBakes, WhatNobodyAsksForIsLeftOutInTime) {
    const std::filesystem::path file = scratch("bakes") / "sky";
    SkyBakes first(file);
    first.add(1, "old");
    first.add(2, "used");
    first.save();
    for (Hash i = 0; i <= SkyBakes::kMostAge; ++i) {
        SkyBakes next(file);
        EXPECT_TRUE(next.find(2));
        next.add(100 + i, "new");
        next.save();
    }
    SkyBakes last(file);
    EXPECT_FALSE(last.find(1));
    EXPECT_EQ(last.find(2), "used");
}

TEST(SkyBakes, DamagedFilesAreEmpty) {
    const std::filesystem::path file = scratch("bakes") / "sky";
    SkyBakes first(file);
    for (Hash i = 0; i < 20; ++i)
        first.add(i, std::string(i, 'x'));
    first.save();
    const std::string bytes = read_file(file);
    PcgRandom random(5);
    for (int i = 0; i < 500; ++i) {
        const std::string other = hostile::mutated(bytes, random);
        write_file(file, other);
        SkyBakes bakes(file);
        EXPECT_EQ(bakes.find(3).has_value(), other == bytes);
    }
}
