// SPDX-License-Identifier: GPL-3.0-or-later
// Chunk errors: how far off each chunk of a large surface's levels is.
#pragma once

#include "hierarchy/candidate.h"
#include "hierarchy/finest.h"

namespace lodestone::hierarchy {

/// Gives the chunks of levels (finest first, as they come into the model) errors of their own
/// (SurfaceLevel::errors): what chunk_error.cpp measures of each, by the rules for whole levels. What
/// has no place within a level (looks that moved, patches of other light) counts in all of its
/// chunks, and what is seen from the worst side in those that have anything as far off. No chunk has
/// less than a finer level's chunk in it. A level that is made as bright as the finest, or has one
/// chunk, keeps its own error alone. `original`: the chunks of the finest; null: there are none.
void measure_chunks(std::vector<StandInCandidate>& levels, const SurfaceLevel* original,
                    const MeasuredFinest& finest, const Job& job);

}  // namespace lodestone::hierarchy
