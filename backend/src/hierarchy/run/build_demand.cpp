// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/run/build_demand.h"

#include "choose/criterion.h"
#include "hierarchy/counted_error.h"
#include "hierarchy/run/effort_estimate.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace lodestone::hierarchy {
namespace {

// The triangles that a smooth thing needs, over its size (radius) / error.
// Law: a facet of edge h is h^2 / 8 r off, and a sphere has 29 r^2 / h^2 of them.
constexpr double kTrianglesPerSizeOverError = 3.6;
// Law: the triangles of a box.
constexpr uint64_t kLeastTriangles = 12;

/// How the picture shows one stale thing.
struct PictureNeed {
    double error = -1;   // the least error any of its occurrences allows, metres; < 0: none shown
    uint64_t below = 0;  // groups: occurrences drawn for it
};

double triangles_within(double size, double error) {
    const double wanted = error > 0 ? kTrianglesPerSizeOverError * size / error : 1e30;
    return std::max(static_cast<double>(kLeastTriangles), wanted);
}

class DemandSurvey {
public:
    DemandSurvey(const Model& model, const std::vector<StaleObject>& stale,
                 const BuildDemand& demand, const Job& job)
        : model_(model), cut_(choose::choose_cut(model, demand.view, job)), shown_(stale.size()) {
        for (size_t i = 0; i < stale.size(); ++i) {
            position_[stale[i].index] = i;
            for (const ObjectIndex copy : stale[i].copies)
                position_[copy] = i;
        }
        std::vector<uint64_t> below(cut_.nodes.size(), 0);
        for (size_t i = cut_.nodes.size(); i-- > 0;) {  // children follow their parents
            const choose::CutNode& node = cut_.nodes[i];
            if (!node.opened)
                below[i] = 1;
            if (node.parent != choose::kNoParent)
                below[node.parent] += below[i];
            const auto at = position_.find(node.object);
            if (at == position_.end())
                continue;
            PictureNeed& shown = shown_[at->second];
            shown.below += below[i];
            const double allowed = error_allowed(node, demand.view);
            shown.error = shown.error < 0 ? allowed : std::min(shown.error, allowed);
        }
    }

    const choose::Cut& cut() const { return cut_; }

    /// CPU seconds that the picture saves.
    double gain(size_t position, ObjectIndex index, uint64_t group_triangles) const {
        const PictureNeed& shown = shown_[position];
        if (shown.error < 0)
            return 0;
        const Object& object = model_.objects[index];
        const double wanted = triangles_within(object.bound().radius, shown.error);
        if (object.group())
            return wanted < static_cast<double>(group_triangles)
                       ? static_cast<double>(shown.below) * model_.costs.occurrence_s
                       : 0;
        const double has = static_cast<double>(object.representations[0].summary.cost.triangles);
        return std::max(0.0, has - wanted) * model_.costs.triangle_s;
    }

    /// Whether all that a group places has its stand-ins, or will have.
    bool complete_below(ObjectIndex group, const std::vector<uint8_t>& called) const {
        const auto& placements = model_.objects[group].representations[0].assembly().placements;
        return std::all_of(placements.begin(), placements.end(), [&](const Placement& placement) {
            const auto at = position_.find(placement.object);
            return at == position_.end() || called[at->second] != 0;
        });
    }

private:
    double error_allowed(const choose::CutNode& node, const View& view) const {
        const Object& object = model_.objects[node.object];
        const Affine& world = cut_.world(node);
        const double z = distance(transformed(object.bound(), world), view.camera.position);
        const double enlarged = stretch(world);
        const double counted = counted_error(1, object.role == ObjectRole::Environment, 0);
        return enlarged > 0 ? view.pixel_error * choose::pixel_size(view, z) / enlarged / counted
                            : 0;
    }

    const Model& model_;
    choose::Cut cut_;
    std::map<ObjectIndex, size_t> position_;  // in stale
    std::vector<PictureNeed> shown_;
};

}  // namespace

std::vector<uint8_t> select_demanded(const Model& model, const std::vector<StaleObject>& stale,
                                     const BuildSettings& settings, const Job& job) {
    const BuildDemand& demand = settings.demand.value();
    const DemandSurvey survey(model, stale, demand, job);
    std::vector<uint8_t> called(stale.size(), 0);
    double left = demand.share * seconds_to_draw(model, survey.cut(), demand.view);
    const auto take = [&](size_t i) {
        const double seconds = seconds_to_build(model.objects[stale[i].index], settings);
        if (seconds > left)
            return;
        called[i] = 1;
        left -= seconds;
    };

    std::vector<size_t> leaves;
    std::vector<double> worth(stale.size(), 0);  // seconds saved for each spent
    for (size_t i = 0; i < stale.size(); ++i) {
        const Object& object = model.objects[stale[i].index];
        if (object.group())
            continue;
        worth[i] = survey.gain(i, stale[i].index, settings.group_triangles) /
                   seconds_to_build(object, settings);
        if (worth[i] > 0)
            leaves.push_back(i);
    }
    std::stable_sort(leaves.begin(), leaves.end(),
                     [&](size_t a, size_t b) { return worth[a] > worth[b]; });
    for (const size_t i : leaves)
        take(i);
    for (size_t i = 0; i < stale.size(); ++i) {
        const ObjectIndex index = stale[i].index;
        if (model.objects[index].group() && survey.gain(i, index, settings.group_triangles) > 0 &&
            survey.complete_below(index, called))
            take(i);
    }
    return called;
}

}  // namespace lodestone::hierarchy
