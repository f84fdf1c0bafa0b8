// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/proposers/solid_candidates.h"

#include "hierarchy/evaluators/distance_error.h"
#include "hierarchy/proposers/pruned_levels.h"
#include "solids/composite_replacement.h"
#include "solids/keep_on_floor.h"
#include "solids/solid_replacement.h"
#include "solids/stand_in_material.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace lodestone::hierarchy {
namespace {

/// Many parts of a few triangles each: how far their points are from those of fewer tells little.
bool is_foliage(const prune::Crowd& crowd) {
    constexpr size_t kFewestLeaves = 256;
    constexpr size_t kTriangles = 8;  // of a leaf, in the mean
    return crowd.parts.size() >= kFewestLeaves &&
           crowd.triangles <= kTriangles * crowd.parts.size();
}

/// A box and an ellipsoid, compared by pictures, if there are any: something that is not solid has
/// clear ones too. One that is farther off than another may be told an infinite error: they cost
/// the same.
void add_primitives(std::vector<StandInCandidate>& candidates, const Bound& bound,
                    const MeasuredFinest& finest, const FinestPictures* pictures, const Job& job) {
    const Material material = solids::mean_material(finest.attributes);
    double nearest = std::numeric_limits<double>::infinity();
    const auto add = [&](Kind kind, const Primitive& primitive, double opacity) {
        StandInCandidate candidate;
        candidate.kind = kind;
        candidate.primitive = primitive;
        candidate.materials = {solids::clear_material(material, opacity)};
        candidate.by_few_rays = true;
        if (pictures) {
            compare_pictures(candidate, {}, finest, *pictures, job);
        } else {
            candidate.state = CandidateState::Unproven;
            measure_primitive(candidate, finest, nearest, job);
            nearest = std::min(nearest, candidate.error);
        }
        candidates.push_back(std::move(candidate));
    };
    // Nothing sinks into the plane that its original stands on. What floats above it may be the
    // better one (a tree's crown), or not (a table's top): the error decides.
    const double floor = bound.box.low.z;
    const auto add_standing = [&](Kind kind, const Primitive& primitive) {
        const bool is_box = kind == Kind::Box;
        const solids::HeightRange reach = solids::reach_of(primitive, is_box);
        add(kind, solids::kept_above(primitive, is_box, floor), 1);
        constexpr double kStands = 0.01;  // over its height
        if (reach.low - floor > kStands * (reach.high - reach.low))
            add(kind, solids::standing_on(primitive, is_box, floor), 1);
    };
    if (const auto box = solids::fit_box(finest.attributes, bound))
        add_standing(Kind::Box, *box);
    if (const auto ellipsoid = solids::fit_ellipsoid(finest.attributes, bound))
        add_standing(Kind::Ellipsoid, *ellipsoid);
    if (!pictures)
        return;
    if (const auto box = solids::fit_clear_box(finest.attributes, bound))
        add(Kind::Box, solids::kept_above(box->primitive, true, floor), box->opacity);
    if (const auto ellipsoid = solids::fit_clear_ellipsoid(finest.attributes, bound))
        add(Kind::Ellipsoid, solids::kept_above(ellipsoid->primitive, false, floor),
            ellipsoid->opacity);
}

/// How many solids may be of use beside the parts of the whole.
size_t most_solids(const std::vector<StandInCandidate>& candidates, const ReplacedObject& whole) {
    constexpr size_t kMost = 32;
    // It is used up to the error of the next one, and what its parts cost is asked for half way.
    double next = std::numeric_limits<double>::infinity();
    for (const StandInCandidate& candidate : candidates) {
        if (candidate.kind != Kind::Mesh)
            next = std::min(next, candidate.error);
    }
    const double least = kOff * whole.bound.radius;
    const double used = std::isfinite(next) ? std::sqrt(least * std::max(next, least)) : least;
    size_t out = kMost;
    const auto useless = [&](size_t solids) {
        const auto bytes = static_cast<double>(solids * kBytesPerPrimitive);
        return bytes > whole.most || (whole.cheaper_from && whole.cheaper_from(bytes) <= used);
    };
    while (out > 0 && useless(out))
        out /= 2;
    return out;
}

StandInCandidate candidate_of(const solids::ClusteredComposite& level) {
    StandInCandidate out;
    out.kind = Kind::Composite;
    out.composite = std::make_shared<const Composite>(level.composite);
    for (size_t i = 0; i < level.attributes.size(); ++i)
        out.materials.push_back(
            solids::clear_material(solids::mean_material(level.attributes[i]), level.opacities[i]));
    return out;
}

/// Whether a composite of that error would be of use beside the others, and beside the parts of the
/// whole.
bool would_pay(const StandInCandidate& composite, double error,
               const std::vector<StandInCandidate>& others, const ReplacedObject& whole) {
    const double own = bytes_of(composite, whole.uses);
    double next = std::numeric_limits<double>::infinity();  // the cheaper one that takes over
    for (const StandInCandidate& other : others) {
        if (bytes_of(other, whole.uses) <= own)
            next = std::min(next, other.error);
    }
    if (error >= next)
        return false;
    if (!whole.cheaper_from)
        return true;
    const double used = std::isfinite(next) ? std::sqrt(error * next) : error;
    return whole.cheaper_from(static_cast<double>(bytes_of(composite))) > used;
}

/// `airy`: clear ones too, of these parts, of at most so many solids.
void add_composites(std::vector<StandInCandidate>& candidates, const Mesh& mesh, bool airy,
                    const prune::Crowd& crowd, size_t most, const MeasuredFinest& finest,
                    const FinestPictures& pictures, const ReplacedObject& whole, const Job& job) {
    // Exact matching takes most of the time, and rarely makes a composite nearer than a rough one
    // that shows as much (of 357 levels a tenth came to .6 of its error or less, half to as much or
    // more): only those that may pay by these are matched. Fewer solids are hardly ever much
    // nearer: where not even that would pay, one picture is enough.
    constexpr double kNearer = 0.7;
    constexpr double kFewerNearer = 0.75;
    constexpr uint32_t kFewRays = 1024;
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
            exact.least = std::bit_ceil(rough.back().composite->solids.size());
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

SolidCandidates::SolidCandidates(const Mesh& mesh,
                                 const std::function<prune::Crowd()>& crowd_in_mesh,
                                 const ReplacedObject& whole, const MeasuredFinest& finest,
                                 FinestPictures& pictures, const Job& job)
    : mesh_(mesh), whole_(whole), finest_(finest), pictures_(pictures) {
    // Less than so many solids would cost is not worth a tenth of a second of pictures.
    constexpr double kFewSolids = 32;
    if (whole.bytes > kFewSolids * kBytesPerPrimitive && !finest.refracts()) {
        crowd_ = crowd_in_mesh();
        by_pictures_ = !finest.solid() || (!crowd_.empty() && (whole.many || is_foliage(crowd_)));
    }
    if (!by_pictures_ && !whole.ground && finest.solid())
        add_primitives(solids_, whole.bound, finest, nullptr, job);
}

double SolidCandidates::nearest_solid() const {
    double out = std::numeric_limits<double>::infinity();
    for (const StandInCandidate& solid : solids_)
        out = std::min(out, solid.error);
    return out;
}

void SolidCandidates::add(std::vector<StandInCandidate>& candidates, double level_ratio,
                          const Job& job) {
    using Pictures = measure::AgreementReference;
    const double radius = whole_.bound.radius;
    const bool dear =
        bytes_within(candidates, kNear * radius, whole_.uses) > kCollapsed * whole_.bytes;
    const bool thinned = !crowd_.empty() && (whole_.many || is_foliage(crowd_) || dear);
    const bool by_pictures = by_pictures_ || thinned;
    if (by_pictures)
        pictures_.take(mesh_, thinned ? Pictures::kSide : Pictures::kCoarseSide, job);
    if (thinned)
        add_pruned_levels(candidates, mesh_, crowd_, level_ratio,
                          triangles_for(whole_.most, whole_.uses), finest_, pictures_, job);
    if (!by_pictures)
        candidates.insert(candidates.end(), solids_.begin(), solids_.end());
    else if (!whole_.ground)
        add_primitives(candidates, whole_.bound, finest_, &pictures_, job);
    // Solids that the same memory would hold. Few collapsed triangles beside a smooth thing are as
    // good, and comparing pictures takes long.
    const double solids = by_pictures ? 16 : 64;
    const double dearer =
        solids * kBytesPerPrimitive * static_cast<double>(std::max<uint64_t>(1, whole_.uses));
    constexpr size_t kFewest = 4;  // solids of the cheapest
    const size_t most = whole_.ground ? 0 : most_solids(candidates, whole_);
    if (most >= kFewest && !finest_.refracts() && whole_.bytes > 2 * dearer &&
        bytes_within(candidates, kOff * radius, whole_.uses) > dearer) {
        if (!by_pictures)
            pictures_.take(mesh_, Pictures::kCoarseSide, job);
        add_composites(candidates, mesh_, by_pictures, thinned ? crowd_ : prune::Crowd{}, most,
                       finest_, pictures_, whole_, job);
    }
}

size_t triangles_for(double bytes, uint64_t uses) {
    const double all = bytes * static_cast<double>(std::max<uint64_t>(1, uses));
    return static_cast<size_t>(std::clamp(all / kBytesPerTriangle, 0.0, 1e9));
}

}  // namespace lodestone::hierarchy
