// SPDX-License-Identifier: GPL-3.0-or-later
// Guards parallel loops: each item has its turn, and what is thrown arrives.
#include "base/parallel.h"

#include <atomic>
#include <gtest/gtest.h>
#include <stdexcept>
#include <vector>

using namespace lodestone;

TEST(Parallel, EachItemHasItsTurn) {
    for (const size_t count : {0, 1, 2, 1000}) {
        std::vector<int> turns(count, 0);
        parallel_for(count, [&](size_t i) { ++turns[i]; });
        EXPECT_EQ(turns, std::vector<int>(count, 1));
    }
}

TEST(Parallel, WhatIsThrownArrivesAndTheRestIsLeft) {
    for (const int threads : {0, 1, 2, 7}) {
        const ThreadLimit limit(threads);
        std::atomic<size_t> done{0};
        try {
            parallel_for(1'000'000, [&](size_t i) {
                if (i == 70)
                    throw std::runtime_error("seventy");
                ++done;
            });
            FAIL();
        } catch (const std::runtime_error& error) {
            EXPECT_STREQ(error.what(), "seventy");
        }
        EXPECT_LT(done, 1'000'000u);
    }
}

// TBB sometimes crashed where loops in loops were left by exceptions, as when a bake is stopped.
TEST(Parallel, LoopsInLoopsMayBeStopped) {
    for (int round = 0; round < 3000; ++round) {
        std::atomic<int> done{0};
        const auto stop = [&] {
            if (++done > 20 + round % 50)
                throw std::runtime_error("stopped");
        };
        EXPECT_THROW(parallel_for(8,
                                  [&](size_t) {
                                      stop();
                                      for (int i = 0; i < 5; ++i) {
                                          parallel_for(8, [&](size_t) {
                                              parallel_for(4, [&](size_t) { stop(); });
                                          });
                                      }
                                  }),
                     std::runtime_error);
    }
}
