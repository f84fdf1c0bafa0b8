// SPDX-License-Identifier: GPL-3.0-or-later
// Flips: edges turned within the two triangles on them where that is nearer to the original.
#pragma once

#include "simplify/fit/fit_samples.h"

namespace lodestone::simplify {

/// Flips inner edges where the samples of the two triangles on them then miss less, in distance and
/// normal, best gain first, no vertex twice; gives these samples their new places. Seams, slots'
/// borders and folds stay, no edge is made that there is. Returns how many; `adjacency` is that of
/// before. The same on any number of threads. source: Hoppe et al. 1993 (edge swap).
size_t flip_edges(FitPlaces& places, const Adjacency& adjacency, const Job& job,
                  FitSamples& samples);

}  // namespace lodestone::simplify
