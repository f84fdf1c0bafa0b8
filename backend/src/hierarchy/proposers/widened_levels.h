// SPDX-License-Identifier: GPL-3.0-or-later
// Widen: levels whose thin parts are as wide as a pixel, and as clear as they cover it.
#pragma once

#include "hierarchy/proposers/proposal_round.h"

namespace lodestone::hierarchy {

/// Where much of a leaf is few long and thin loose parts (posts, wires, rails) that are opaque and
/// do not glow: replaces its levels that are off by more than these are thick by *widened* ones, in
/// which each such part is a clear box as wide as the error (solids/widened_boxes) and everything
/// else is what it was; the last of them by several of rising widths. Of a pixel of which an opaque
/// part covers p one sample is off by 2 p (1 - p), whatever the level; of one that is as wide as
/// the pixel and has alpha p by about p / 2. So no opaque level of more error is left. Candidates
/// are finest first, and as bright as the finest. An error is the level's own, half of the width,
/// or what pictures say in which everything else is the finest's, whichever is most. Bytes never
/// rise with the error.
void propose_widened_levels(ProposalRound& round);

}  // namespace lodestone::hierarchy
