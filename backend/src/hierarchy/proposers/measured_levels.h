// SPDX-License-Identifier: GPL-3.0-or-later
// Measured levels: simpler meshes of something, with their errors, as far as they may be of use.
#pragma once

#include "hierarchy/proposers/proposal_round.h"

namespace lodestone::hierarchy {

/// Proposes levels of the triangles that are wanted, fine to coarse. Measured from the coarsest on:
/// what will not be near enough, by the one before it, is not measured at all.
void propose_levels(ProposalRound& round);

}  // namespace lodestone::hierarchy
