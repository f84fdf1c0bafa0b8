// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/proposers/measured_levels.h"

#include "hierarchy/evaluators/distance_error.h"
#include "hierarchy/evaluators/lamp_glow.h"
#include "hierarchy/proposers/collapse_levels.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace lodestone::hierarchy {

void add_levels(std::vector<StandInCandidate>& candidates, const Mesh& mesh,
                const std::vector<size_t>& targets, const LevelLimits& wanted,
                const MeasuredFinest& finest, const Job& job) {
    const std::vector<Material>& materials = finest.materials;
    // A level is hardly ever more than so many times nearer than the next coarser one (of 836 pairs
    // in groups: a tenth; of 275 that would have to be, one).
    constexpr double kMostNearer = 4;
    if (targets.empty())
        return;
    Mesh plain;
    const Mesh& source = without_unseen_colors(mesh, materials, plain);
    std::vector<Mesh> levels = simplify_with_lamps(source, materials, targets, job);
    std::vector<StandInCandidate> measured;
    std::vector<double> nexts{wanted.solid};  // where a level may end, and one of them takes over
    double coarser = 0;
    for (size_t i = levels.size(); i-- > 0;) {
        Mesh& level = levels[i];
        // What it saves is asked for half way to the next, on a scale of powers.
        const double useless = wanted.useless(level.triangles.size());
        double most = wanted.told;
        for (const double next : nexts)
            most = std::max(
                most, std::isfinite(next) ? std::min(next, useless * useless / next) : useless);
        if (level.empty() || (useless > 0 && coarser > kMostNearer * useless)) {
            coarser /= kMostNearer;
            continue;
        }
        const measure::DeviationReference::RepaintResult known = repaint(level, finest, job, most);
        StandInCandidate candidate;
        candidate.mesh = std::make_shared<Mesh>(std::move(level));
        candidate.materials = materials;
        candidate.state = CandidateState::Unproven;
        measure_mesh(candidate, finest, job, most, known);
        coarser = std::min(candidate.error, std::max(most, useless));
        if (!std::isfinite(coarser))
            coarser = most;  // it is farther than that
        if (candidate.error < wanted.solid)
            nexts.push_back(candidate.error);
        if (std::isfinite(candidate.error))
            measured.push_back(std::move(candidate));
    }
    candidates.insert(candidates.end(), std::make_move_iterator(measured.rbegin()),
                      std::make_move_iterator(measured.rend()));
}

}  // namespace lodestone::hierarchy
