// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/object_stand_ins.h"

#include "hierarchy/candidate_selection.h"
#include "hierarchy/evaluators/brightness_match.h"
#include "hierarchy/evaluators/chunk_error.h"
#include "hierarchy/evaluators/distance_error.h"
#include "hierarchy/evaluators/solid_settling.h"
#include "hierarchy/flattened_group.h"
#include "hierarchy/group_limits.h"
#include "hierarchy/proposers/collapse_levels.h"
#include "hierarchy/proposers/proposers.h"
#include "hierarchy/run/stand_in_surroundings.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestone::hierarchy {
namespace {

/// Seals those of a group's levels (finest first) that the cut would open for children which cost
/// less, but do not look like the group where the next level takes over. The same children serve
/// from less error on, where they look no worse.
void seal(std::vector<StandInCandidate>& levels, OpenedGroup& group, const MeasuredFinest& finest,
          FinestPictures& pictures, const MeshSource& source, const Job& job) {
    // The error, over the radius, at which the coarsest level is tried.
    // Taste: all children are as coarse as they get; a larger value changes nothing.
    constexpr double kFarthest = 4;
    const CostModel& costs = group.model().costs;
    double next = kFarthest * group.model().objects[group.index()].bound().radius;
    for (size_t i = levels.size(); i-- > 0;) {
        const double error = std::nextafter(std::max(next, levels[i].error), 0.0);
        next = levels[i].error;
        const auto own = static_cast<double>(bytes_of(levels[i], costs) + costs.occurrence_bytes);
        if (group.drawn_within(error, job).alone >= own)
            continue;
        const FlattenedGroup children = flatten_group(group, error, source, job);
        if (!looks_alike(children.mesh, children.materials, error, finest, pictures, job))
            come_to(levels[i], CandidateState::Sealed);
    }
}

/// The cheapest stand-in of a group for which none pays: every group has one, even one that saves
/// nothing but the occurrences.
std::vector<StandInCandidate> cheapest_of(ProposalRound& round) {
    std::vector<StandInCandidate> out;
    while (out.empty() && !round.candidates.empty()) {
        out = round.candidates;
        keep_pareto_front(out, ~uint64_t{0}, round.limits.whole.costs);
        out = {out.back()};
        prove_candidates(out, round.candidates, round.finest, round.job);
    }
    if (out.empty()) {
        StandInCandidate all;
        all.payload = std::make_shared<const Mesh>(round.limits.mesh);
        all.materials = round.finest.materials;
        measure_mesh(all, round.finest, round.job);
        out.push_back(std::move(all));
    }
    match_brightness(out[0], round.finest, round.pictures, std::numeric_limits<double>::infinity(),
                     round.job);
    return out;
}

/// How many triangles a group is flattened to: a third of its own, as far as the settings allow.
uint64_t triangles_to_flatten(const RepresentationSummary& finest, const BuildSettings& settings) {
    // Taste: a larger number flattens small groups finer, in time in proportion.
    constexpr uint64_t kFewest = 1000;
    return std::min(settings.group_triangles,
                    std::max<uint64_t>(kFewest, finest.cost.triangles / 3));
}

uint64_t seed_of(const Object& object, const BuildSettings& settings) {
    return Hasher().value(object.shape_hash).value(settings.seed).result();
}

}  // namespace

StandIns stand_ins_of_leaf(const Model& model, ObjectIndex leaf,
                           const StandInSurroundings& surroundings, const BuildSettings& settings,
                           const MeshSource& source, image::TexelCache& texels, const Job& job) {
    StandIns out;
    const Object& object = model.objects[leaf];
    const RepresentationSummary& original = object.representations.at(0).summary;
    const std::shared_ptr<const Mesh> mesh = source(object.representations[0]);
    if (mesh->empty())
        return out;
    FinestOptions options{seed_of(object, settings)};
    options.environment = object.role == ObjectRole::Environment;
    options.in_layers = surroundings.layers[leaf] != 0;
    const MeasuredFinest finest = measure_finest(
        *mesh, materials_of(model, object.representations[0]), texels, settings, options, job);
    out.attributes = finest.attributes;
    if (out.attributes.empty())
        return out;

    ProposalLimits limits{*mesh, {original.bound, surroundings.uses[leaf], model.costs}};
    limits.whole.bytes = static_cast<double>(mesh->triangles.size() * model.costs.triangle_bytes);
    limits.whole.most = bytes_per_occurrence(Kind::Mesh, original.cost.bytes, limits.whole.uses);
    limits.whole.ground = surroundings.ground[leaf] != 0;
    limits.level_ratio = settings.level_ratio;
    limits.targets = targets_of(*mesh, settings);
    limits.surface = true;
    limits.told = options.environment ? 0 : kOff * original.bound.radius;
    limits.find_crowd = [&] { return prune::find_crowd(*mesh); };
    FinestPictures pictures(finest);
    ProposalRound round(finest, pictures, limits, job);
    propose(ProposalStage::All, round);

    const auto keep = [&](std::vector<StandInCandidate>& candidates) {
        keep_pareto_front(candidates, original.cost.bytes, model.costs, limits.whole.uses);
    };
    round.candidates = select_candidates(round.candidates, keep, finest, pictures, job);
    settle_solids(round.candidates, finest, original.bound.box.low.z, job);
    paint_boxes(round.candidates, keep, finest);
    propose(ProposalStage::Kept, round);
    measure_chunks(round.candidates, round.surface.get(), finest, job);
    out.candidates = std::move(round.candidates);
    out.surface = std::move(round.surface);
    return out;
}

StandIns stand_ins_of_group(const Model& model, ObjectIndex group,
                            const StandInSurroundings& surroundings, const BuildSettings& settings,
                            const MeshSource& source, image::TexelCache& texels, const Job& job) {
    StandIns out;
    if (surroundings.hidden[group] != 0)
        return out;  // always opened: rays of one class see other parts of it than those of another
    const Object& object = model.objects[group];
    OpenedGroup opened(model, group, surroundings.uses);
    const uint64_t wanted = triangles_to_flatten(object.representations.at(0).summary, settings);
    const double fine = error_to_flatten(opened, wanted, settings.group_triangles, job);
    const FlattenedGroup reference = flatten_group(opened, fine, source, job);
    if (reference.mesh.empty())
        return out;
    out.sources = reference.sources;
    FinestOptions options{seed_of(object, settings)};
    options.environment = surroundings.environment[group] != 0;
    options.in_layers = lies_on_a_layer(model, group, surroundings.layers);
    options.group = true;
    options.child_error = reference.child_error;
    const MeasuredFinest finest =
        measure_finest(reference.mesh, reference.materials, texels, settings, options, job);
    out.attributes = finest.attributes;
    if (out.attributes.empty())
        return out;

    const GroupLimits limits(opened, reference, finest, surroundings, settings, job);
    FinestPictures pictures(finest);
    ProposalRound round(finest, pictures, limits.limits(), job);
    propose(ProposalStage::All, round);

    const auto keep = [&](std::vector<StandInCandidate>& candidates) {
        limits.keep_useful(candidates);
    };
    std::vector<StandInCandidate> useful =
        select_candidates(round.candidates, keep, finest, pictures, job);
    const bool saves = !useful.empty();
    round.candidates = saves ? std::move(useful) : cheapest_of(round);
    settle_solids(round.candidates, finest, bound_of(limits.limits().mesh.positions).box.low.z,
                  job);
    if (saves) {  // else children are the cheaper choice, however they look
        paint_boxes(round.candidates, keep, finest);
        propose(ProposalStage::Kept, round);
        seal(round.candidates, opened, finest, pictures, source, job);
    }
    out.candidates = std::move(round.candidates);
    return out;
}

}  // namespace lodestone::hierarchy
