// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the set of hashes: each is new once, whatever its bits.
#include "base/hash_set.h"

#include <gtest/gtest.h>
#include <set>

using namespace lodestone;

TEST(HashSet, EachIsNewOnce) {
    HashSet set(0);
    EXPECT_TRUE(set.insert(7));
    EXPECT_FALSE(set.insert(7));
    EXPECT_TRUE(set.insert(8));
}

TEST(HashSet, ZeroIsAHashLikeAnyOther) {
    HashSet set(3);
    EXPECT_TRUE(set.insert(0));
    EXPECT_FALSE(set.insert(0));
    EXPECT_TRUE(set.insert(1));
}

TEST(HashSet, HashesThatWantOnePlaceAreToldApart) {
    HashSet set(100);
    for (int round = 0; round < 2; ++round) {
        for (Hash high = 0; high < 100; ++high)
            EXPECT_EQ(set.insert(high << 40u), round == 0) << high;
    }
}

TEST(HashSet, AsManyAsWereToldAreWhatASetHolds) {
    HashSet set(20000);
    std::set<Hash> held;
    for (uint64_t i = 0; i < 20000; ++i) {
        const Hash hash = Hasher().value(i * i % 4999).result();
        EXPECT_EQ(set.insert(hash), held.insert(hash).second);
    }
}
