// SPDX-License-Identifier: GPL-3.0-or-later
// Painted boxes: a crowd of objects as one mesh of a few boxes, with a color for each side.
#pragma once

#include "hierarchy/proposers/proposal_round.h"

namespace lodestone::hierarchy {

/// Proposes, for a group of many opaque things of about one size that are no foliage, one mesh each
/// of a box, and of 4, 8, ... 128 for clusters of what is seen, compared by pictures. A solid over
/// gaps has the light of its sides where the finest has that of walls and of shadow between them:
/// each side is given the color in which it sends the finest's light. One mesh is one thing to
/// place and to trace, and occurrences share it.
void propose_painted_boxes(ProposalRound& round);

}  // namespace lodestone::hierarchy
