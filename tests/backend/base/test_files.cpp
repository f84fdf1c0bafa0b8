// SPDX-License-Identifier: GPL-3.0-or-later
// Guards files: whole or not at all, under any name a file system holds.
#include "base/error.h"
#include "base/files.h"

#include <filesystem>
#include <gtest/gtest.h>
#include <locale>
#include <sys/stat.h>
#include <unistd.h>

using namespace lodestone;
namespace fs = std::filesystem;

namespace {

fs::path scratch(const std::string& name) {
    fs::path folder = fs::path(LODESTONE_TEST_SCRATCH) / "files" / name;
    fs::remove_all(folder);
    fs::create_directories(folder);
    return folder;
}

size_t entries(const fs::path& folder) {
    return static_cast<size_t>(
        std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

}  // namespace

TEST(Files, ANameOf255BytesIsWritten) {
    const fs::path folder = scratch("long");
    for (const std::string& name : {std::string(255, 'a'), std::string(255, '\xff')}) {
        write_file(folder / name, "old");
        write_file(folder / name, "new");
        EXPECT_EQ(read_file(folder / name), "new");
    }
    EXPECT_EQ(entries(folder), 2u);
    EXPECT_THROW(write_file(folder / std::string(256, 'a'), "more"), Error);
    EXPECT_EQ(entries(folder), 2u);
}

TEST(Files, WhatAKilledProcessOfOurNumberLeftIsNotInTheWay) {
    const fs::path folder = scratch("left");
    for (int i = 0; i < 100; ++i)
        write_file(folder / text(".lodestone-", getpid(), "-", i + 50, ".tmp"), "left");
    for (int i = 0; i < 10; ++i)
        write_file(folder / text("file", i), "new");
    EXPECT_EQ(entries(folder), 110u);
    for (int i = 0; i < 10; ++i)
        EXPECT_EQ(read_file(folder / text("file", i)), "new");
}

TEST(Files, APipeThatNobodyWritesToIsRefusedInsteadOfWaitedFor) {
    const fs::path pipe = scratch("pipe") / "model.obj";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    alarm(20);  // or it would wait forever
    EXPECT_THROW(read_file(pipe), Error);
    alarm(0);
}

TEST(Files, ALockThatCannotBeMadeIsNotTakenForAnotherWriter) {
    const fs::path path = scratch("lock") / "none" / "lock";
    try {
        const FileLock lock(path);
        ADD_FAILURE() << "a lock in no folder";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("cannot lock"), std::string::npos);
    }
}

TEST(Text, NumbersAreWrittenAlikeWhateverTheHostsLocaleIs) {
    struct Grouped : std::numpunct<char> {
        char do_decimal_point() const override { return ','; }
        char do_thousands_sep() const override { return '.'; }
        std::string do_grouping() const override { return "\3"; }
    };
    const std::locale before = std::locale::global(std::locale(std::locale(), new Grouped));
    const std::string words = text("+W", 1920, ' ', 1.5);
    std::locale::global(before);
    EXPECT_EQ(words, "+W1920 1.5");
}

TEST(Files, NamesThatLeaveTheFolderAreNotSafe) {
    for (const char* name : {"", ".", "..", "/a", "a/../b", "a//b", "a/", "./a", "a b", "a\nb",
                             "caf\xc3\xa9", "a\"b", "$(a)", "-a;b"})
        EXPECT_FALSE(safe_relative_name(name)) << name;
    EXPECT_FALSE(safe_relative_name(std::string(241, 'a')));
    for (const char* name : {"a", "r/0123456789abcdef.glb", "...", "-a", ".hidden"})
        EXPECT_TRUE(safe_relative_name(name)) << name;
}
