// SPDX-License-Identifier: GPL-3.0-or-later
// Edge flips: edges turned within their two triangles where that is nearer to the original.
#pragma once

#include "simplify/fit/fit_samples.h"

namespace lodestone::simplify {

/// Flips inner edges where the samples of the two triangles on them then miss less, in distance and
/// normal. The best gain comes first, and no vertex takes part twice; the samples get their new
/// places. Seams, slots' borders and folds stay, and no edge is made that exists. Returns the
/// number of flips; `adjacency` is that of before. Any number of threads gives the same result.
/// source: Hoppe et al. 1993 (edge swap).
size_t flip_edges(FitPlaces& places, const Adjacency& adjacency, const Job& job,
                  FitSamples& samples);

}  // namespace lodestone::simplify
