// SPDX-License-Identifier: GPL-3.0-or-later
// Primitive solids: a box and an ellipsoid of all that is seen.
#pragma once

#include "hierarchy/proposers/proposal_round.h"

namespace lodestone::hierarchy {

/// Measures what costs little, by distance, where that tells enough, and keeps it in mind.
void propose_near_solids(ProposalRound& round);

/// Proposes those that were kept in mind, or others by pictures, clear ones among them.
void propose_primitives(ProposalRound& round);

}  // namespace lodestone::hierarchy
