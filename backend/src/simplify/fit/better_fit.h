// SPDX-License-Identifier: GPL-3.0-or-later
// Better fit: of a level before and after its fit, what is nearer to the original, vertex by
// vertex.
#pragma once

#include "simplify/fit/level_errors.h"

namespace lodestone::simplify {

/// Moves vertices of `after` back to where they are in `before` until no error of the whole (mean,
/// root mean square, largest distance, outline) is larger than before: those that became worse in
/// mean and square, and, where an error of the whole became larger, those that made it so. Both are
/// levels of `source`; edges of `after` may have been flipped, a few vertices collapsed and a few
/// inserted, which stay. No triangle turns over. Returns false when no way back was found, and
/// `before` is the better one.
bool keep_better(CollapseMesh& before, CollapseMesh& after, const Mesh& source,
                 const LevelMeter& meter, const Job& job);

}  // namespace lodestone::simplify
