// SPDX-License-Identifier: GPL-3.0-or-later
// View errors: whether an eye sees a candidate nowhere much farther off than its error.
#pragma once

#include "hierarchy/candidate.h"
#include "hierarchy/finest.h"

namespace lodestone::hierarchy {

/// Something seen from one side may be so many times farther off than the error: few pixels tell
/// it.
/// Taste: a larger value lets stand-ins be farther off where they are seen from one side only.
inline constexpr double kFartherInView = 1.25;

/// Makes the error of a candidate what is seen from the worst side, where that is more: `viewed`.
/// `mesh` is what rays meet of it (traced_mesh), `scene` holds that.
void count_views(StandInCandidate& candidate, const Mesh& mesh, const ray::MeshScene& scene,
                 const MeasuredFinest& finest, const Job& job);
/// The same of one of which no scene was made.
void count_views(StandInCandidate& candidate, const MeasuredFinest& finest, const Job& job);

}  // namespace lodestone::hierarchy
