// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/proposers/measured_levels.h"

#include "hierarchy/evaluators/distance_error.h"
#include "hierarchy/proposers/collapse_levels.h"
#include "hierarchy/proposers/lamp_levels.h"
#include "hierarchy/proposers/surface_chunks.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace lodestone::hierarchy {
namespace {

/// The error of the nearest solid that is of use, and costs less than any level; infinite without
/// one.
double nearest_of_use(const ProposalRound& round) {
    const ReplacedObject& whole = round.limits.whole;
    double out = std::numeric_limits<double>::infinity();
    for (const StandInCandidate& solid : round.near_solids)
        out = std::min(out, solid.error);
    const bool used =
        std::isfinite(out) &&
        (!whole.pays ||
         whole.pays(bytes_per_occurrence(Kind::Box, whole.costs.primitive_bytes, whole.uses), out));
    return used ? out : std::numeric_limits<double>::infinity();
}

}  // namespace

void propose_levels(ProposalRound& round) {
    // A level is hardly ever more than so many times nearer than the next coarser one.
    // Fitted: to levels of groups (a tenth of 836 pairs; one of 275 that would have to be); the
    // script was not kept.
    constexpr double kMostNearer = 4;
    const ProposalLimits& limits = round.limits;
    const MeasuredFinest& finest = round.finest;
    const Job& job = round.job;
    if (limits.targets.empty())
        return;
    Mesh plain;
    const Mesh& source = without_unseen_colors(limits.mesh, finest.materials, plain);
    simplify::SimplifiedSurface surface;
    if (limits.surface && is_large_surface(source) && !has_lamps(source, finest.materials))
        surface = simplify_in_chunks(source, limits.targets, job);
    else
        surface.levels = simplify_with_lamps(source, finest.materials, limits.targets, job);
    std::vector<Mesh>& levels = surface.levels;
    round.surface = surface.original;
    std::vector<StandInCandidate> measured;
    const double solid = nearest_of_use(round);
    std::vector<double> nexts{solid};  // where a level may end, and one of them takes over
    double coarser = 0;
    for (size_t i = levels.size(); i-- > 0;) {
        Mesh& level = levels[i];
        // The memory that the level saves is asked for half way to the next, on a logarithmic
        // scale.
        const double useless = limits.useless ? limits.useless(level.triangles.size())
                                              : std::numeric_limits<double>::infinity();
        double most = limits.told;
        for (const double next : nexts)
            most = std::max(
                most, std::isfinite(next) ? std::min(next, useless * useless / next) : useless);
        if (level.empty() || (useless > 0 && coarser > kMostNearer * useless)) {
            coarser /= kMostNearer;
            continue;
        }
        const measure::DeviationReference::RepaintResult known = repaint(level, finest, job, most);
        StandInCandidate candidate;
        candidate.payload = std::make_shared<const Mesh>(std::move(level));
        candidate.materials = finest.materials;
        if (surface.original != nullptr)
            candidate.surface = surface.chunks[i];
        candidate.state = CandidateState::Unproven;
        measure_mesh(candidate, finest, job, most, known);
        coarser = std::min(candidate.error, std::max(most, useless));
        if (!std::isfinite(coarser))
            coarser = most;  // it is farther than that
        if (candidate.error < solid)
            nexts.push_back(candidate.error);
        if (std::isfinite(candidate.error))
            measured.push_back(std::move(candidate));
    }
    round.candidates.insert(round.candidates.end(), std::make_move_iterator(measured.rbegin()),
                            std::make_move_iterator(measured.rend()));
}

}  // namespace lodestone::hierarchy
