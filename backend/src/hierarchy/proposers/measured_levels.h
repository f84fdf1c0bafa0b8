// SPDX-License-Identifier: GPL-3.0-or-later
// Measured levels: simpler meshes of something, with their errors, as far as they may be of use.
#pragma once

#include "hierarchy/candidate.h"
#include "hierarchy/finest.h"

#include <functional>
#include <limits>

namespace lodestone::hierarchy {

/// What makes levels worth measuring.
struct LevelLimits {
    /// The error from which on a mesh of so many triangles is no use, whatever else there is.
    std::function<double(size_t triangles)> useless;
    /// Of what is kept in any case and costs less than a level; infinite where there is nothing.
    double solid = std::numeric_limits<double>::infinity();
    /// Errors up to this are told in any case where they are measured.
    double told = 0;
};

/// Levels of so many triangles, fine to coarse. Measured from the coarsest on: what will not be
/// near enough, by the one before it, is not measured at all.
void add_levels(std::vector<StandInCandidate>& candidates, const Mesh& mesh,
                const std::vector<size_t>& targets, const LevelLimits& wanted,
                const MeasuredFinest& finest, const Job& job);

}  // namespace lodestone::hierarchy
