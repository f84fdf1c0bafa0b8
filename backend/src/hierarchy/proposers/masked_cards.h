// SPDX-License-Identifier: GPL-3.0-or-later
// Masked cards: crossed cards that stand for trees and bushes.
#pragma once

#include "hierarchy/proposers/proposal_round.h"

namespace lodestone::hierarchy {

/// Proposes crossed cards for what is cut out of masks.
void propose_cards(ProposalRound& round);

}  // namespace lodestone::hierarchy
