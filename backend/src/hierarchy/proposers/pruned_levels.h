// SPDX-License-Identifier: GPL-3.0-or-later
// Pruned levels: foliage, fences and crowds with fewer and larger parts.
#pragma once

#include "hierarchy/proposers/proposal_round.h"

namespace lodestone::hierarchy {

/// Proposes levels of a mesh with a crowd in it, where that is foliage, its parts are objects, or
/// collapsed levels cost too much: of the crowd some parts, enlarged until each kind shows as much
/// as in the mesh; of everything else as many triangles in proportion. They are compared by
/// pictures.
void propose_pruned_levels(ProposalRound& round);

}  // namespace lodestone::hierarchy
