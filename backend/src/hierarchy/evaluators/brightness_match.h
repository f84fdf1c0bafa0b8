// SPDX-License-Identifier: GPL-3.0-or-later
// Brightness matches: what is used from afar sends as much light as the finest.
#pragma once

#include "hierarchy/candidate.h"
#include "hierarchy/evaluators/picture_error.h"
#include "hierarchy/finest.h"

namespace lodestone::hierarchy {

/// Whether match_brightness() does anything to what is used so far.
bool is_matched(const MeasuredFinest& finest, double used_to);

/// Makes a candidate that is Measured, if it is used from far enough (up to an error of `used_to`,
/// where the next one takes over), as bright as the finest, by the colors of all its slots, and
/// lets it glow as much: Matched. Shades that much alike are one look to errors; but of a mesh
/// counts what is seen through gaps, and where it is off by a twelfth of the radius half of the
/// pixel size from which on pictures agree: what is near something else may have been all that
/// closed a gap.
void match_brightness(StandInCandidate& candidate, const MeasuredFinest& finest,
                      FinestPictures& pictures, double used_to, const Job& job);

}  // namespace lodestone::hierarchy
