// SPDX-License-Identifier: GPL-3.0-or-later
// Patch errors: whether a candidate shows as much surface as the finest, and about as much light at
// each place.
#pragma once

#include "hierarchy/candidate.h"
#include "hierarchy/finest.h"

namespace lodestone::hierarchy {

/// The share of the size of patches that look different which is their error.
/// Taste: a larger value keeps finer levels where colors differ.
inline constexpr double kPatches = 0.5;
/// The share of the size of patches that are shaded otherwise which is their error: patches of three
/// pixels are to be shaded alike, so that fine terrain keeps its relief (SSIM 0.95 at 1 px).
/// Fitted: by tests/bench/sheets/bench_shading.py; a larger value keeps finer levels.
inline constexpr double kShading = 0.36;

/// False for a level of the finest's materials that shows another amount of surface.
bool shows_as_much(const Mesh& level, const MeasuredFinest& finest, const Job& job);

/// Looks at a candidate that is Unproven. False for a mesh that shows another amount of surface.
/// Otherwise the error becomes at least kPatches of the size of patches that do not look like the
/// finest's, kShading of that of patches of an object that are shaded otherwise, and what is
/// seen of it from the worst side (view_error.h). `used_to`: the error from which on another is
/// used.
bool prove(StandInCandidate& candidate, const MeasuredFinest& finest, double used_to,
           const Job& job);

}  // namespace lodestone::hierarchy
