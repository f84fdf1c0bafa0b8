// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/proposers/composite_solids.h"

#include "solids/composite_replacement.h"
#include "solids/stand_in_material.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace lodestone::hierarchy {
namespace {

/// How many solids may be of use beside the parts of the whole.
size_t most_solids(const std::vector<StandInCandidate>& candidates, const ReplacedObject& whole) {
    // Taste: a larger number tries larger composites, which are matched slowly and rarely pay.
    constexpr size_t kMost = 32;
    // A composite is used up to the error of the next one; the costs of its parts are asked for
    // half way.
    double next = std::numeric_limits<double>::infinity();
    for (const StandInCandidate& candidate : candidates) {
        if (candidate.kind != Kind::Mesh)
            next = std::min(next, candidate.error);
    }
    const double least = kOff * whole.bound.radius;
    const double used = std::isfinite(next) ? std::sqrt(least * std::max(next, least)) : least;
    size_t out = kMost;
    const auto useless = [&](size_t solids) {
        const auto bytes = static_cast<double>(solids * whole.costs.primitive_bytes);
        return bytes > whole.most || (whole.cheaper_from && whole.cheaper_from(bytes) <= used);
    };
    while (out > 0 && useless(out))
        out /= 2;
    return out;
}

StandInCandidate candidate_of(const solids::ClusteredComposite& level) {
    StandInCandidate out;
    out.kind = Kind::Composite;
    out.payload = std::make_shared<const Composite>(level.composite);
    for (size_t i = 0; i < level.attributes.size(); ++i) {
        out.materials.push_back(
            solids::clear_material(solids::mean_material(level.attributes[i]), level.opacities[i]));
        out.means.push_back(level.attributes[i].shares);
    }
    return out;
}

/// Whether a composite of that error would be of use beside the others, and beside the parts of the
/// whole.
bool would_pay(const StandInCandidate& composite, double error,
               const std::vector<StandInCandidate>& others, const ReplacedObject& whole) {
    const double own = bytes_of(composite, whole.uses, whole.costs);
    double next = std::numeric_limits<double>::infinity();  // the cheaper one that takes over
    for (const StandInCandidate& other : others) {
        if (bytes_of(other, whole.uses, whole.costs) <= own)
            next = std::min(next, other.error);
    }
    if (error >= next)
        return false;
    if (!whole.cheaper_from)
        return true;
    const double used = std::isfinite(next) ? std::sqrt(error * next) : error;
    return whole.cheaper_from(static_cast<double>(bytes_of(composite, whole.costs))) > used;
}

/// `airy`: clear ones too, of these parts, of at most so many solids.
void add_composites(std::vector<StandInCandidate>& candidates, const Mesh& mesh, bool airy,
                    const prune::Crowd& crowd, size_t most, const MeasuredFinest& finest,
                    const FinestPictures& pictures, const ReplacedObject& whole, const Job& job) {
    // Exact matching takes most of the time, and rarely makes a composite nearer than a rough one
    // that shows as much: only those that may pay by these are matched. Fewer solids are hardly
    // ever much nearer: where not even that would pay, one picture is enough.
    // Fitted: of 357 levels a tenth came to 0.6 of the error of the rough one or less, half to as
    // much or more; the script was not kept.
    constexpr double kNearer = 0.7;
    // Taste: a smaller value compares more pictures of composites with fewer solids.
    constexpr double kFewerNearer = 0.75;
    // Taste: more rays make the rough composites better, in time in proportion.
    constexpr uint32_t kFewRays = 1024;
    // Taste: more samples make the rough composites better, in time in proportion.
    constexpr uint32_t kFewSamples = 2048;
    // Between leaves one sees far into a crown: a solid with the same variances would be too small.
    solids::CompositeOptions options{finest.options.seed};
    options.shape = !airy;
    options.most = most;
    solids::CompositeOptions few = options;
    few.shape = false;
    few.rounds = 0;
    few.rays = kFewRays;
    few.samples = kFewSamples;
    solids::CompositeOptions exact = options;
    exact.settled = 0;  // those that are kept are
    exact.least = exact.most = 0;
    std::vector<StandInCandidate> rough;  // fewest solids first
    for (const solids::ClusteredComposite& level :
         solids::composites(mesh, finest.skin, finest.attributes, few, job))
        rough.push_back(candidate_of(level));
    for (bool more = true; more && !rough.empty(); rough.pop_back()) {
        compare_pictures(rough.back(), {}, finest, pictures, job);
        const double error = kNearer * rough.back().error;
        if (would_pay(rough.back(), error, candidates, whole)) {
            // It may be one of fewer than were asked for.
            exact.least = std::bit_ceil(rough.back().composite().solids.size());
            exact.most = std::max(exact.most, exact.least);
            continue;
        }
        more = exact.most == 0 &&
               std::any_of(rough.begin(), rough.end(), [&](const StandInCandidate& other) {
                   return would_pay(other, kFewerNearer * error, candidates, whole);
               });
    }
    std::vector<solids::ClusteredComposite> levels;
    if (exact.most > 0)
        levels = solids::composites(mesh, finest.skin, finest.attributes, exact, job);
    if (airy) {
        for (solids::ClusteredComposite& level : solids::clear_composites(
                 mesh, finest.skin, crowd.part_of, finest.attributes, options, job))
            levels.push_back(std::move(level));
    }
    for (const solids::ClusteredComposite& level : levels) {
        StandInCandidate candidate = candidate_of(level);
        candidate.by_few_rays = options.shape;
        compare_pictures(candidate, {}, finest, pictures, job);
        candidates.push_back(std::move(candidate));
    }
}

}  // namespace

void propose_composites(ProposalRound& round) {
    // How many solids the memory of a near level must hold for composites to be tried. Few
    // collapsed triangles beside a smooth thing are as good, and comparing pictures takes long.
    // Taste: a larger number tries composites for fewer things.
    constexpr double kSolidsByPictures = 16;
    // Taste: a larger number tries composites for fewer things that distances tell of.
    constexpr double kSolidsByDistance = 64;
    // The solids of the cheapest composite.
    // Taste: a larger number tries composites for fewer things.
    constexpr size_t kFewest = 4;
    const ReplacedObject& whole = round.limits.whole;
    if (round.finest.options.environment || whole.ground || round.painted)
        return;
    // Parts are solids themselves from far. Where distances tell well, composites of them are
    // hardly ever drawn.
    if (round.finest.options.group && !round.by_pictures)
        return;
    const double solids = round.by_pictures ? kSolidsByPictures : kSolidsByDistance;
    const double dearer = solids * static_cast<double>(whole.costs.primitive_bytes) *
                          static_cast<double>(std::max<uint64_t>(1, whole.uses));
    const size_t most = most_solids(round.candidates, whole);
    if (most < kFewest || round.finest.refracts() || !(whole.bytes > 2 * dearer) ||
        !(bytes_within(round.candidates, kOff * whole.bound.radius, whole.uses, whole.costs) >
          dearer))
        return;
    round.pictures.take(round.limits.mesh, measure::AgreementReference::kCoarseSide, round.job);
    add_composites(round.candidates, round.limits.mesh, round.by_pictures,
                   round.pruned ? round.crowd : prune::Crowd{}, most, round.finest, round.pictures,
                   whole, round.job);
}

}  // namespace lodestone::hierarchy
