// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/proposers/primitive_solids.h"

#include "hierarchy/evaluators/distance_error.h"
#include "hierarchy/evaluators/patch_error.h"
#include "solids/keep_on_floor.h"
#include "solids/solid_replacement.h"
#include "solids/stand_in_material.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestone::hierarchy {
namespace {

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
        candidate.payload = primitive;
        candidate.materials = {solids::clear_material(material, opacity)};
        candidate.means = {finest.attributes.shares};
        candidate.by_few_rays = true;
        if (pictures) {
            compare_pictures(candidate, {}, finest, *pictures, job);
        } else {
            candidate.state = CandidateState::Unproven;
            measure_primitive(candidate, finest, nearest, job);
            nearest = std::min(nearest, candidate.error);
            // Beside a crowd a solid is near in space and looks different: that must not end
            // levels.
            if (finest.options.group && std::isfinite(candidate.error))
                prove(candidate, finest, std::numeric_limits<double>::infinity(), job);
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
        // The gap above the floor, over the height of the solid, that counts as none.
        // Taste: a larger value leaves solids that hover visibly.
        constexpr double kStands = 0.01;
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

}  // namespace

void propose_near_solids(ProposalRound& round) {
    const MeasuredFinest& finest = round.finest;
    const ReplacedObject& whole = round.limits.whole;
    if (!finest.options.environment && !round.by_pictures && !whole.ground && finest.solid())
        add_primitives(round.near_solids, whole.bound, finest, nullptr, round.job);
}

void propose_primitives(ProposalRound& round) {
    if (round.finest.options.environment || round.painted)
        return;
    if (!round.by_pictures) {
        round.candidates.insert(round.candidates.end(), round.near_solids.begin(),
                                round.near_solids.end());
        return;
    }
    // Whatever is compared later is so by these pictures, if this proposes nothing too.
    round.pictures.take(round.limits.mesh, measure::AgreementReference::kCoarseSide, round.job);
    if (!round.limits.whole.ground)
        add_primitives(round.candidates, round.limits.whole.bound, round.finest, &round.pictures,
                       round.job);
}

}  // namespace lodestone::hierarchy
