// SPDX-License-Identifier: GPL-3.0-or-later
// Proposers: all that may stand for an original, a row each.
#pragma once

#include "hierarchy/proposers/proposal_round.h"

#include <span>
#include <string_view>

namespace lodestone::hierarchy {

/// When a proposer is asked.
enum class ProposalStage {
    All,   // It adds to the candidates, of which some are selected then.
    Kept,  // It replaces some of those that were selected, which are finest first.
};

/// A row: what it proposes, when, and how. It proposes nothing where it has nothing to say.
struct StandInProposer {
    std::string_view name;
    ProposalStage stage;
    void (*propose)(ProposalRound& round);
};

/// In the order in which they are asked.
std::span<const StandInProposer> stand_in_proposers();

/// Asks those of a stage, one after the other.
void propose(ProposalStage stage, ProposalRound& round);

}  // namespace lodestone::hierarchy
