// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/group_limits.h"

#include "hierarchy/candidate_selection.h"
#include "hierarchy/counted_error.h"
#include "hierarchy/environment_objects.h"
#include "hierarchy/proposers/collapse_levels.h"
#include "hierarchy/run/stand_in_surroundings.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace lodestone::hierarchy {
namespace {

// So many things drawn in a group may be a crowd.
// Taste: a larger number looks for crowds in fewer groups.
constexpr size_t kManyChildren = 32;
// So many of about one size are one, as a block of houses is. A house among its fences and bushes
// is none.
// Taste: a larger number has fewer crowds.
constexpr double kManyAlike = 16;

/// Leaves out what no ray from outside reaches (of the occurrences too); everything stays when
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

/// The number of things of one size that would be as alike as the occurrences are: the square of
/// all area over the sum of the squares of theirs. source: Simpson 1949.
double things_alike(const Mesh& shell, const std::vector<uint32_t>& occurrence) {
    std::map<uint32_t, double> areas;
    for (size_t i = 0; i < shell.triangles.size(); ++i)
        areas[occurrence[i]] += glm::length(area_vector(shell, i));
    double sum = 0;
    double squares = 0;
    for (const auto& [number, area] : areas) {
        sum += area;
        squares += area * area;
    }
    return squares > 0 ? sum * sum / squares : 0;
}

/// The first of numbers that fall by `ratio`, at most `first`, so that one of them is `sure`.
size_t first_above(size_t sure, size_t first, double ratio) {
    auto out = static_cast<double>(sure);
    while (out > 0 && out / ratio <= static_cast<double>(first))
        out /= ratio;
    return static_cast<size_t>(std::ceil(out));
}

/// The crowd in a group: leaves and the like where that is what its children are made of, else the
/// children.
prune::Crowd crowd_in(const Mesh& mesh, const std::vector<uint32_t>& occurrence) {
    // The loose parts of an occurrence, in the mean, from which on it is foliage.
    // Taste: a larger number prunes whole children more often than their leaves.
    constexpr size_t kPartsOfFoliage = 16;
    prune::Crowd parts = prune::find_crowd(mesh);
    const std::set<uint32_t> drawn(occurrence.begin(), occurrence.end());
    if (parts.parts.size() >= kPartsOfFoliage * drawn.size())
        return parts;
    return prune::find_crowd(mesh, occurrence);
}

bool lies_on_a_layer(const Model& model, ObjectIndex index, const std::vector<Hash>& layers,
                     std::set<ObjectIndex>& asked) {
    // The share of the group's radius that makes a child most of it.
    // Taste: a larger value finds fewer groups that lie on a layer.
    constexpr double kMost = 0.5;
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

}  // namespace

bool lies_on_a_layer(const Model& model, ObjectIndex group, const std::vector<Hash>& layers) {
    std::set<ObjectIndex> asked;
    return lies_on_a_layer(model, group, layers, asked);
}

ChildCosts::ChildCosts(OpenedGroup& group, double error, const Job& job) {
    // The errors at which costs are asked for are powers of two, over the radius.
    // Taste: a larger one knows less of fine levels, for a search less.
    constexpr int kFinest = -10;
    // Taste: a larger one asks for errors that are larger than any group is seen with.
    constexpr int kCoarsest = 3;
    const auto add = [&](double at) { steps_.push_back({at, group.drawn_within(at, job).bytes}); };
    add(error);
    for (int power = kFinest; power < kCoarsest; ++power) {
        const double at = std::ldexp(group.model().objects[group.index()].bound().radius, power);
        if (at > error)
            add(at);
    }
}

double ChildCosts::cheaper_from(double bytes) const {
    for (const CostStep& step : steps_) {
        if (step.bytes <= bytes)
            return step.error;
    }
    return std::numeric_limits<double>::infinity();
}

GroupLimits::GroupLimits(OpenedGroup& group, const FlattenedGroup& reference,
                         const MeasuredFinest& finest, const StandInSurroundings& surroundings,
                         const BuildSettings& settings, const Job& job)
    : group_(group),
      job_(job),
      occurrence_(reference.occurrence),
      shell_(without_hidden(reference.mesh, finest.seen_triangles(), occurrence_)),
      // A stand-in is off by as much as the reference or more, and no use where it costs more than
      // what the children use there.
      children_(group, reference.child_error, job),
      limits_{shell_,
              {group.model().objects[group.index()].bound(), group.uses(), group.model().costs}} {
    ReplacedObject& whole = limits_.whole;
    const CostModel& costs = whole.costs;
    whole.bytes = static_cast<double>(shell_.triangles.size() * costs.triangle_bytes);
    whole.most = children_.bytes() - static_cast<double>(costs.occurrence_bytes);
    whole.many = reference.occurrences >= kManyChildren;
    whole.alike = whole.many && things_alike(shell_, occurrence_) >= kManyAlike;
    const std::optional<size_t> ground =
        ground_of(group.model(), group.index(), surroundings.marked);
    whole.ground = ground.has_value();
    whole.cheaper_from = [this](double bytes) {
        return children_.cheaper_from(bytes +
                                      static_cast<double>(limits_.whole.costs.occurrence_bytes));
    };
    whole.pays = [this](double bytes, double error) { return pays(bytes, error); };
    first_ = std::min(shell_.triangles.size(), triangles_for(whole.most, whole.uses, costs));
    limits_.level_ratio = settings.level_ratio;
    // However coarse the children are, one mesh of so many triangles costs less.
    const size_t sure = triangles_for(
        children_.least() - static_cast<double>(costs.occurrence_bytes), whole.uses, costs);
    if (sure >= kFewestTriangles && sure < first_)
        first_ = first_above(sure, first_, settings.level_ratio);
    limits_.targets = targets_of(shell_.triangles.size() + 1, first_, settings.level_ratio);
    const auto fifth =
        static_cast<size_t>(kCollapsed * static_cast<double>(shell_.triangles.size()));
    if (!finest.options.environment && !whole.many && first_ < fifth)
        limits_.targets.insert(limits_.targets.begin(), fifth);  // tells whether it is a crowd
    const size_t coarsest = limits_.targets.empty() ? 0 : limits_.targets.back();
    limits_.told = kOff * whole.bound.radius;
    limits_.useless = [this, coarsest](size_t triangles) {
        if (triangles > first_)
            return 0.0;  // the probe is no stand-in
        // The coarsest is what there is where nothing is of use.
        if (triangles <= coarsest)
            return std::numeric_limits<double>::infinity();
        const ReplacedObject& group_as_whole = limits_.whole;
        return group_as_whole.cheaper_from(bytes_per_occurrence(
            Kind::Mesh, triangles * group_as_whole.costs.triangle_bytes, group_as_whole.uses));
    };
    limits_.find_crowd = [this] { return crowd_in(shell_, occurrence_); };
    for (const uint32_t one : reference.occurrence)
        limits_.environment.push_back(
            reference.environment[one] != 0 || reference.placement[one] == ground ? 1 : 0);
}

bool GroupLimits::pays(double bytes, double error) const {
    return bytes + static_cast<double>(limits_.whole.costs.occurrence_bytes) <
           group_.drawn_within(error, job_).bytes;
}

void GroupLimits::keep_useful(std::vector<StandInCandidate>& candidates) const {
    const CostModel& costs = limits_.whole.costs;
    const RepresentationSummary& finest =
        group_.model().objects[group_.index()].representations.at(0).summary;
    keep_pareto_front(candidates, finest.cost.bytes, costs, group_.uses());
    // Each is used from its own error to the next one's; what children cost is asked for half way,
    // on a scale of powers.
    double next = 0;  // 0: nothing is coarser
    for (size_t i = candidates.size(); i-- > 0;) {
        const double own = bytes_per_occurrence(candidates[i].kind, bytes_of(candidates[i], costs),
                                                group_.uses()) +
                           tracing_of(candidates[i], costs);
        const double error = candidates[i].error;
        if (pays(own, next > 0 ? std::sqrt(error * next) : error))
            next = error;
        else
            candidates.erase(candidates.begin() + static_cast<std::ptrdiff_t>(i));
    }
    // Where all of the group is less than a pixel there is a nearer one that does not cost much.
    const double diagonal = glm::length(limits_.whole.bound.box.size());
    while (candidates.size() > 1 && candidates.back().error > diagonal)
        candidates.pop_back();
}

}  // namespace lodestone::hierarchy
