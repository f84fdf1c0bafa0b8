// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/candidate_selection.h"

#include "hierarchy/evaluators/brightness_match.h"
#include "hierarchy/evaluators/patch_error.h"
#include "hierarchy/evaluators/view_error.h"
#include "hierarchy/lamp_materials.h"
#include "solids/painted_box.h"

#include <algorithm>
#include <iterator>
#include <limits>

namespace lodestone::hierarchy {
namespace {

/// Whether both stand for one thing that was tried.
bool is_same(const StandInCandidate& a, const StandInCandidate& b) {
    return a.kind == b.kind && is_same(a.payload, b.payload);
}

/// Makes a box a mesh of vertex colors where its sides are not of one color.
void paint_sides(StandInCandidate& candidate, const MeasuredFinest& finest) {
    if (candidate.kind != Kind::Box || candidate.state == CandidateState::Pictured ||
        !finest.patches || candidate.materials[0].alpha_mode != AlphaMode::Opaque ||
        emits(candidate.materials[0]))
        return;
    std::optional<solids::PaintedBox> painted =
        solids::painted_box(candidate.primitive(), candidate.materials[0],
                            finest.patches->fitted_vertex_colors(
                                tessellate_box(candidate.primitive()), finest.scene()));
    if (!painted)
        return;
    candidate.kind = Kind::Mesh;
    candidate.payload = std::make_shared<const Mesh>(std::move(painted->mesh));
    candidate.materials = {std::move(painted->material)};
}

}  // namespace

void keep_pareto_front(std::vector<StandInCandidate>& candidates, uint64_t finest_bytes,
                       const CostModel& costs, uint64_t uses) {
    // A level that saves less than this over a better one is not worth its place on disk.
    // Taste: a larger value keeps fewer levels.
    constexpr double kSameCost = 1.02;
    const auto bytes = [&](const StandInCandidate& candidate) {
        return bytes_of(candidate, uses, costs);
    };
    std::stable_sort(candidates.begin(), candidates.end(),
                     [&](const StandInCandidate& a, const StandInCandidate& b) {
                         return bytes(a) != bytes(b) ? bytes(a) < bytes(b) : a.error < b.error;
                     });
    std::vector<StandInCandidate> front;  // cheapest first, errors falling
    for (StandInCandidate& candidate : candidates) {
        if (bytes(candidate) >= static_cast<double>(finest_bytes) ||
            (!front.empty() && candidate.error >= front.back().error))
            continue;
        if (!front.empty() && bytes(candidate) < kSameCost * bytes(front.back()))
            front.back() = std::move(candidate);
        else
            front.push_back(std::move(candidate));
    }
    std::reverse(front.begin(), front.end());
    candidates = std::move(front);
}

bool prove_candidates(std::vector<StandInCandidate>& some, std::vector<StandInCandidate>& all,
                      const MeasuredFinest& finest, const Job& job) {
    bool changed = false;
    for (size_t i = some.size(); i-- > 0;) {
        const bool unproven = some[i].state == CandidateState::Unproven;
        if (!unproven && some[i].viewed)
            continue;
        StandInCandidate proven = some[i];
        const double next =
            i + 1 < some.size() ? some[i + 1].error : std::numeric_limits<double>::infinity();
        const bool good = !unproven || prove(proven, finest, next, job);
        if (!unproven)
            count_views(proven, finest, job);
        changed = changed || !good || proven.error > some[i].error;
        for (size_t k = all.size(); k-- > 0;) {
            if (!is_same(all[k], some[i]))
                continue;
            if (good)
                all[k] = proven;
            else
                all.erase(all.begin() + static_cast<std::ptrdiff_t>(k));
        }
        if (good)
            some[i] = std::move(proven);
        else
            some.erase(some.begin() + static_cast<std::ptrdiff_t>(i));
    }
    return changed;
}

std::vector<StandInCandidate> select_candidates(std::vector<StandInCandidate>& all,
                                                const Keep& keep, const MeasuredFinest& finest,
                                                FinestPictures& pictures, const Job& job) {
    for (;;) {
        std::vector<StandInCandidate> kept = all;
        keep(kept);
        if (prove_candidates(kept, all, finest, job))
            continue;
        bool farther = false;
        for (size_t i = 0; i < kept.size(); ++i) {
            const bool last = i + 1 == kept.size();
            const StandInCandidate before = kept[i];
            match_brightness(kept[i], finest, pictures,
                             last ? std::numeric_limits<double>::infinity() : kept[i + 1].error,
                             job);
            farther = farther || kept[i].error > before.error;
            if (before.state == kept[i].state)
                continue;
            for (StandInCandidate& candidate : all) {
                if (is_same(candidate, before))
                    candidate = kept[i];
            }
        }
        if (!farther)
            return kept;
    }
}

void paint_boxes(std::vector<StandInCandidate>& kept, const Keep& keep,
                 const MeasuredFinest& finest) {
    std::vector<StandInCandidate> painted = kept;
    for (StandInCandidate& candidate : painted)
        paint_sides(candidate, finest);
    keep(painted);
    if (!painted.empty())
        kept = std::move(painted);
}

}  // namespace lodestone::hierarchy
