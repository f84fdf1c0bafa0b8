// SPDX-License-Identifier: GPL-3.0-or-later
// Composite solids: up to 32 boxes and ellipsoids together.
#pragma once

#include "hierarchy/proposers/proposal_round.h"

namespace lodestone::hierarchy {

/// Proposes composites, compared by pictures, where they promise more than what is there: clear
/// ones too of what is seen through.
void propose_composites(ProposalRound& round);

}  // namespace lodestone::hierarchy
