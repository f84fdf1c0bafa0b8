// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the cache of shared values: each is made once, and those used longest ago go first.
#include "base/parallel.h"
#include "base/recent_values.h"

#include <atomic>
#include <chrono>
#include <gtest/gtest.h>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace lodestone {
namespace {

size_t size_of(const std::string& value) {
    return value.size();
}

/// A value of ten bytes that counts how often it is made.
std::shared_ptr<const std::string> ten(RecentValues<std::string>& values, Hash key, int& made) {
    return values.of(
        key,
        [&made] {
            ++made;
            return std::make_shared<const std::string>(10, 'x');
        },
        size_of);
}

TEST(RecentValues, AValueIsMadeOnce) {
    RecentValues<std::string> values(100);
    EXPECT_EQ(values.bytes(), 0u);
    int made = 0;
    const auto first = ten(values, 1, made);
    EXPECT_EQ(ten(values, 1, made), first);
    EXPECT_EQ(made, 1);
    EXPECT_EQ(values.bytes(), 10u);
    EXPECT_NE(ten(values, 2, made), first);
    EXPECT_EQ(made, 2);
}

TEST(RecentValues, WhatWasUsedLongestAgoIsForgotten) {
    RecentValues<std::string> values(30);
    int made = 0;
    const auto kept = ten(values, 1, made);
    for (const Hash key : {2, 3, 1, 4})
        ten(values, key, made);
    EXPECT_EQ(made, 4);
    EXPECT_EQ(values.bytes(), 30u);
    EXPECT_EQ(ten(values, 1, made), kept);
    EXPECT_EQ(made, 4);
    ten(values, 2, made);
    EXPECT_EQ(made, 5) << "two was used longest ago when four came";
}

TEST(RecentValues, OneThatIsLargerThanAllTheCacheIsTheOnlyOne) {
    RecentValues<std::string> values(5);
    int made = 0;
    ten(values, 1, made);
    EXPECT_EQ(values.bytes(), 10u);
    ten(values, 1, made);
    EXPECT_EQ(made, 1);
    ten(values, 2, made);
    EXPECT_EQ(values.bytes(), 10u);
}

TEST(RecentValues, NothingIsKeptOfWhatCannotBeMade) {
    RecentValues<std::string> values(100);
    const auto fails = []() -> std::shared_ptr<const std::string> {
        throw std::runtime_error("no");
    };
    EXPECT_THROW(values.of(1, fails, size_of), std::runtime_error);
    EXPECT_EQ(values.bytes(), 0u);
    int made = 0;
    EXPECT_EQ(ten(values, 1, made)->size(), 10u);
}

TEST(RecentValues, ThreadsThatWantOneValueGetTheSame) {
    RecentValues<std::string> values(1000);
    std::atomic<int> made{0};
    std::vector<std::shared_ptr<const std::string>> found(64);
    parallel_for(found.size(), [&](size_t i) {
        found[i] = values.of(
            i % 4,
            [&made] {
                ++made;
                std::this_thread::sleep_for(std::chrono::milliseconds(5));  // others come meanwhile
                return std::make_shared<const std::string>(10, 'x');
            },
            size_of);
    });
    EXPECT_EQ(made, 4);
    for (size_t i = 0; i < found.size(); ++i)
        EXPECT_EQ(found[i], found[i % 4]);
}

}  // namespace
}  // namespace lodestone
