// SPDX-License-Identifier: GPL-3.0-or-later
// Distance errors: how far a candidate's surface and its looks are from the finest's.
#pragma once

#include "hierarchy/candidate.h"
#include "hierarchy/finest.h"

#include <limits>

namespace lodestone::hierarchy {

/// Gives a level of the finest's materials the slots that the finest shows there
/// (DeviationReference::repaint()). measure_mesh() may be told the answer, with the same `useless`.
measure::DeviationReference::RepaintResult repaint(
    Mesh& level, const MeasuredFinest& finest, const Job& job,
    double useless = std::numeric_limits<double>::infinity());

/// Fills the errors of a candidate that is a mesh of the finest's materials, or of these and
/// others. Where the error is larger than `useless` it may be less than it is (at_least), and
/// infinite where it is much larger, which takes less time.
void measure_mesh(StandInCandidate& candidate, const MeasuredFinest& finest, const Job& job,
                  double useless = std::numeric_limits<double>::infinity(),
                  const measure::DeviationReference::RepaintResult& known = {});

/// Fills the errors of a box or an ellipsoid of one color; `useless` as for a mesh. All points are
/// asked, of a group too: few do not tell what it hides.
void measure_primitive(StandInCandidate& candidate, const MeasuredFinest& finest, double useless,
                       const Job& job);

/// Measures again, without a limit, what was measured until it was of no use: it turned out to be
/// of use after all.
void measure_to_the_end(StandInCandidate& candidate, const MeasuredFinest& finest, const Job& job);

}  // namespace lodestone::hierarchy
