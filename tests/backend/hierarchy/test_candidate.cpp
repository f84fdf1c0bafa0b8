// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the way of a candidate: no state is skipped, and none is taken back.
#include "base/error.h"
#include "hierarchy/candidate.h"

#include <gtest/gtest.h>
#include <set>
#include <utility>

using namespace lodestone;
using hierarchy::CandidateState;

namespace {

constexpr CandidateState kAll[] = {CandidateState::Unproven, CandidateState::Measured,
                                   CandidateState::Matched, CandidateState::Pictured,
                                   CandidateState::Sealed};

}  // namespace

TEST(StandInCandidate, ItIsLookedAtBeforeItIsMatchedAndSealedLast) {
    using S = CandidateState;
    const std::set<std::pair<S, S>> ways{{S::Unproven, S::Measured}, {S::Measured, S::Matched},
                                         {S::Measured, S::Pictured}, {S::Measured, S::Sealed},
                                         {S::Matched, S::Sealed},    {S::Pictured, S::Sealed}};
    for (const S from : kAll) {
        for (const S to : kAll) {
            hierarchy::StandInCandidate candidate;
            candidate.state = from;
            if (ways.count({from, to}) != 0) {
                EXPECT_NO_THROW(come_to(candidate, to));
                EXPECT_EQ(candidate.state, to);
            } else {
                EXPECT_THROW(come_to(candidate, to), Error);
                EXPECT_EQ(candidate.state, from) << "what fails changes nothing";
            }
        }
    }
}

TEST(StandInCandidate, NoWayLeadsBackToWhereItBegan) {
    for (const CandidateState begin : kAll) {
        std::set<CandidateState> reached;
        for (size_t step = 0; step < std::size(kAll); ++step) {
            for (const CandidateState from : kAll) {
                for (const CandidateState to : kAll) {
                    if ((from == begin || reached.count(from) != 0) && may_follow(from, to))
                        reached.insert(to);
                }
            }
        }
        EXPECT_EQ(reached.count(begin), 0u);
    }
}
