// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/object_stand_ins.h"

#include "hierarchy/candidate_selection.h"
#include "hierarchy/counted_error.h"
#include "hierarchy/environment_objects.h"
#include "hierarchy/evaluators/brightness_match.h"
#include "hierarchy/evaluators/distance_error.h"
#include "hierarchy/evaluators/solid_settling.h"
#include "hierarchy/flattened_group.h"
#include "hierarchy/proposers/collapse_levels.h"
#include "hierarchy/proposers/environment_stand_ins.h"
#include "hierarchy/proposers/measured_levels.h"
#include "hierarchy/proposers/solid_candidates.h"
#include "hierarchy/proposers/widened_levels.h"
#include "hierarchy/run/stand_in_surroundings.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <set>

namespace lodestone::hierarchy {
namespace {

// So many things drawn in a group may be a crowd.
constexpr size_t kManyChildren = 32;

/// What a group's children cost within rising errors.
class ChildCosts {
public:
    /// From `error` on.
    ChildCosts(OpenedGroup& group, double error, const Job& job) {
        constexpr int kFinest = -10;  // powers of two, over the radius
        constexpr int kCoarsest = 3;
        const auto add = [&](double at) {
            steps_.push_back({at, group.drawn_within(at, job).bytes});
        };
        add(error);
        for (int power = kFinest; power < kCoarsest; ++power) {
            const double at =
                std::ldexp(group.model().objects[group.index()].bound().radius, power);
            if (at > error)
                add(at);
        }
    }

    double bytes() const { return steps_.front().bytes; }
    /// The error from which on they cost no more than `bytes`; a step too large rather than too
    /// small.
    double cheaper_from(double bytes) const {
        for (const CostStep& step : steps_) {
            if (step.bytes <= bytes)
                return step.error;
        }
        return std::numeric_limits<double>::infinity();
    }

private:
    struct CostStep {
        double error;
        double bytes;
    };
    std::vector<CostStep> steps_;
};

/// What no ray from outside reaches is left out (of the occurrences too); everything stays when
/// nothing would, and where there is glass, which ends rays but hides nothing (`seen` is empty).
Mesh without_hidden(const Mesh& mesh, const std::vector<uint8_t>& seen,
                    std::vector<uint32_t>& occurrence) {
    if (seen.empty())
        return mesh;
    Mesh shell = subset(mesh, seen);
    if (shell.empty())
        return mesh;
    size_t kept = 0;
    for (size_t i = 0; i < seen.size(); ++i) {
        if (seen[i] != 0)
            occurrence[kept++] = occurrence[i];
    }
    occurrence.resize(kept);
    return shell;
}

/// Of a group: leaves and the like where that is what its children are made of, else the children.
prune::Crowd crowd_in(const Mesh& mesh, const std::vector<uint32_t>& occurrence) {
    constexpr size_t kPartsOfFoliage = 16;  // of an occurrence, in the mean
    prune::Crowd parts = prune::find_crowd(mesh);
    const std::set<uint32_t> drawn(occurrence.begin(), occurrence.end());
    if (parts.parts.size() >= kPartsOfFoliage * drawn.size())
        return parts;
    return prune::find_crowd(mesh, occurrence);
}

/// Whether one flat thing lies under most of a group, as a road lies under its markings; a town of
/// many houses is flat too, but in no layers.
bool lies_on_a_layer(const Model& model, ObjectIndex index, const std::vector<Hash>& layers,
                     std::set<ObjectIndex>& asked) {
    constexpr double kMost = 0.5;  // of the radius
    if (!asked.insert(index).second)
        return false;
    const Object& object = model.objects[index];
    if (!object.group())
        return (layers[index] != 0 || object.role == ObjectRole::Environment) &&
               object.attributes && is_flat(*object.attributes);
    const std::vector<Placement>& placements = object.representations[0].assembly().placements;
    return std::any_of(placements.begin(), placements.end(), [&](const Placement& placement) {
        const Object& child = model.objects[placement.object];
        return !child.representations.empty() &&
               child.bound().radius * stretch(placement.transform) >
                   kMost * object.bound().radius &&
               lies_on_a_layer(model, placement.object, layers, asked);
    });
}

/// Seals those of a group's levels (finest first) that the cut would open for children which cost
/// less, but do not look like the group where the next level takes over. The same children serve
/// from less error on, where they look no worse.
void seal(std::vector<StandInCandidate>& levels, OpenedGroup& group, const MeasuredFinest& finest,
          FinestPictures& pictures, const MeshSource& source, const Job& job) {
    constexpr double kFarthest = 4;  // over the radius: all children are as coarse as they get
    double next = kFarthest * group.model().objects[group.index()].bound().radius;
    for (size_t i = levels.size(); i-- > 0;) {
        const double error = std::nextafter(std::max(next, levels[i].error), 0.0);
        next = levels[i].error;
        const auto own = static_cast<double>(bytes_of(levels[i]) + kBytesPerOccurrence);
        if (group.drawn_within(error, job).alone >= own)
            continue;
        const FlattenedGroup children = flatten_group(group, error, source, job);
        if (!looks_alike(children.mesh, children.materials, error, finest, pictures, job))
            come_to(levels[i], CandidateState::Sealed);
    }
}

uint64_t seed_of(const Object& object, const BuildSettings& settings) {
    return Hasher().value(object.source_hash).value(settings.seed).result();
}

}  // namespace

StandIns stand_ins_of_leaf(const Model& model, ObjectIndex leaf,
                           const StandInSurroundings& surroundings, const BuildSettings& settings,
                           const MeshSource& source, image::TexelCache& texels, const Job& job) {
    StandIns out;
    const Object& object = model.objects[leaf];
    const uint64_t uses = surroundings.uses[leaf];
    const Representation& finest = object.representations.at(0);
    const std::shared_ptr<const Mesh> mesh = source(finest);
    if (mesh->empty())
        return out;
    const std::vector<Material> materials = materials_of(model, finest);
    FinestOptions options{seed_of(object, settings)};
    options.environment = object.role == ObjectRole::Environment;
    options.in_layers = surroundings.layers[leaf] != 0;
    const MeasuredFinest original =
        measure_finest(*mesh, materials, texels, settings, options, job);
    FinestPictures pictures(original);
    out.attributes = original.attributes;
    if (out.attributes.empty())
        return out;
    LevelLimits wanted{[](size_t) { return std::numeric_limits<double>::infinity(); }};
    ReplacedObject whole{finest.summary.bound, uses};
    whole.bytes = static_cast<double>(mesh->triangles.size()) * kBytesPerTriangle;
    whole.most = bytes_per_occurrence(Kind::Mesh, finest.summary.cost.bytes, uses);
    whole.ground = surroundings.ground[leaf] != 0;
    std::optional<SolidCandidates> replacements;
    if (object.role != ObjectRole::Environment) {
        replacements.emplace(
            *mesh, [&] { return prune::find_crowd(*mesh); }, whole, original, pictures, job);
        wanted.solid = replacements->nearest_solid();
        wanted.told = kOff * whole.bound.radius;
    }
    add_levels(out.candidates, *mesh, targets_of(*mesh, settings), wanted, original, job);
    if (replacements)
        replacements->add(out.candidates, settings.level_ratio, job);
    const auto keep = [&](std::vector<StandInCandidate>& candidates) {
        keep_pareto_front(candidates, finest.summary.cost.bytes, uses);
    };
    out.candidates = select_candidates(out.candidates, keep, original, pictures, job);
    settle_solids(out.candidates, original, whole.bound.box.low.z, job);
    paint_boxes(out.candidates, keep, original);
    if (object.role != ObjectRole::Environment)
        widen_thin_parts(out.candidates, original, pictures, job);
    return out;
}

StandIns stand_ins_of_group(const Model& model, ObjectIndex group,
                            const StandInSurroundings& surroundings, const BuildSettings& settings,
                            const MeshSource& source, image::TexelCache& texels, const Job& job) {
    StandIns out;
    if (surroundings.hidden[group] != 0)
        return out;  // always opened: rays of one class see other parts of it than those of another
    const Object& object = model.objects[group];
    const RepresentationSummary& finest = object.representations.at(0).summary;
    const std::vector<uint64_t>& uses = surroundings.uses;
    const bool environment = surroundings.environment[group] != 0;
    const uint64_t budget =
        std::min(settings.group_triangles, std::max<uint64_t>(1000, finest.cost.triangles / 3));
    OpenedGroup opened(model, group, uses);
    const double fine = error_to_flatten(opened, budget, settings.group_triangles, job);
    const FlattenedGroup reference = flatten_group(opened, fine, source, job);
    if (reference.mesh.empty())
        return out;
    std::set<ObjectIndex> asked;
    FinestOptions options{seed_of(object, settings)};
    options.environment = environment;
    options.in_layers = lies_on_a_layer(model, group, surroundings.layers, asked);
    options.group = true;
    options.child_error = reference.child_error;
    const MeasuredFinest original =
        measure_finest(reference.mesh, reference.materials, texels, settings, options, job);
    FinestPictures pictures(original);
    out.attributes = original.attributes;
    if (out.attributes.empty())
        return out;

    std::vector<uint32_t> occurrence = reference.occurrence;
    Mesh shell = without_hidden(reference.mesh, original.seen_triangles(), occurrence);
    const double floor = bound_of(shell.positions).box.low.z;
    // A stand-in is off by as much as the reference or more, and no use where it costs more than
    // what the children use there.
    const ChildCosts children(opened, reference.child_error, job);
    ReplacedObject whole{finest.bound, uses[group]};
    whole.bytes = static_cast<double>(shell.triangles.size() * kBytesPerTriangle);
    whole.most = children.bytes() - static_cast<double>(kBytesPerOccurrence);
    whole.many = reference.occurrences >= kManyChildren;
    const std::optional<size_t> ground = ground_of(model, group, surroundings.marked);
    whole.ground = ground.has_value();
    whole.cheaper_from = [&](double bytes) {
        return children.cheaper_from(bytes + static_cast<double>(kBytesPerOccurrence));
    };
    const size_t count = shell.triangles.size();
    const size_t first = std::min(count, triangles_for(whole.most, uses[group]));
    std::vector<size_t> targets = targets_of(count + 1, first, settings.level_ratio);
    const auto fifth = static_cast<size_t>(kCollapsed * static_cast<double>(count));
    if (!environment && !whole.many && first < fifth)
        targets.insert(targets.begin(), fifth);  // tells whether it is a crowd
    const size_t coarsest = targets.empty() ? 0 : targets.back();
    LevelLimits wanted;
    wanted.told = kOff * finest.bound.radius;
    std::optional<SolidCandidates> replacements;
    if (!environment) {
        replacements.emplace(
            shell, [&] { return crowd_in(shell, occurrence); }, whole, original, pictures, job);
        const double nearest = replacements->nearest_solid();
        const double own = bytes_per_occurrence(Kind::Box, kBytesPerPrimitive, uses[group]) +
                           static_cast<double>(kBytesPerOccurrence);
        if (std::isfinite(nearest) && own < opened.drawn_within(nearest, job).bytes)
            wanted.solid = nearest;
    }
    wanted.useless = [&](size_t triangles) {
        if (triangles > first)
            return 0.0;  // the probe is no stand-in
        // The coarsest is what there is where nothing is of use.
        if (triangles <= coarsest)
            return std::numeric_limits<double>::infinity();
        return whole.cheaper_from(
            bytes_per_occurrence(Kind::Mesh, triangles * kBytesPerTriangle, uses[group]));
    };
    add_levels(out.candidates, shell, targets, wanted, original, job);
    if (replacements)
        replacements->add(out.candidates, settings.level_ratio, job);
    std::vector<uint8_t> around;  // by triangle: whether it is environment
    for (const uint32_t one : reference.occurrence)
        around.push_back(reference.environment[one] != 0 || reference.placement[one] == ground ? 1
                                                                                               : 0);
    add_environment_stand_ins(out.candidates, around, original, job);

    // A stand-in that costs more than what the children would use instead is none: parts that many
    // groups share are cheap, one mesh for each of the groups is not. It is used from its own error
    // to the next one's; what children cost is asked for half way, on a scale of powers.
    const auto keep = [&](std::vector<StandInCandidate>& candidates) {
        keep_pareto_front(candidates, finest.cost.bytes, uses[group]);
        double next = 0;  // 0: nothing is coarser
        for (size_t i = candidates.size(); i-- > 0;) {
            const double own =
                bytes_per_occurrence(candidates[i].kind, bytes_of(candidates[i]), uses[group]) +
                tracing_of(candidates[i]) + static_cast<double>(kBytesPerOccurrence);
            const double error = candidates[i].error;
            const double used = next > 0 ? std::sqrt(error * next) : error;
            if (own < opened.drawn_within(used, job).bytes)
                next = error;
            else
                candidates.erase(candidates.begin() + static_cast<std::ptrdiff_t>(i));
        }
    };
    std::vector<StandInCandidate> useful =
        select_candidates(out.candidates, keep, original, pictures, job);
    const bool saves = !useful.empty();
    if (!saves) {
        // Every group has a stand-in, even one that saves nothing but the occurrences: the
        // cheapest.
        while (useful.empty() && !out.candidates.empty()) {
            useful = out.candidates;
            keep_pareto_front(useful, ~uint64_t{0});
            useful = {useful.back()};
            prove_candidates(useful, out.candidates, original, job);
        }
        if (useful.empty()) {
            StandInCandidate all;
            all.mesh = std::make_shared<Mesh>(std::move(shell));
            all.materials = reference.materials;
            measure_mesh(all, original, job);
            useful.push_back(std::move(all));
        }
        match_brightness(useful[0], original, pictures, std::numeric_limits<double>::infinity(),
                         job);
    }
    settle_solids(useful, original, floor, job);
    if (saves) {  // else children are the cheaper choice, however they look
        paint_boxes(useful, keep, original);
        seal(useful, opened, original, pictures, source, job);
    }
    out.candidates = std::move(useful);
    return out;
}

}  // namespace lodestone::hierarchy
