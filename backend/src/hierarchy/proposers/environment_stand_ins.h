// SPDX-License-Identifier: GPL-3.0-or-later
// Environment stand-ins: the environment of a group as a mesh of few triangles, and solids for
// everything else in it.
#pragma once

#include "hierarchy/proposers/proposal_round.h"

namespace lodestone::hierarchy {

/// Proposes one mesh each: the environment simplified to about as many triangles as what stands on
/// it has, which is a box, an ellipsoid, or a composite of four or eight. Measured by distance, to
/// be proven by patches. Nothing where there is no environment, or nothing else.
void propose_environment_stand_ins(ProposalRound& round);

}  // namespace lodestone::hierarchy
