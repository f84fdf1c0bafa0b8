// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/proposers/pruned_levels.h"

#include "hierarchy/evaluators/visible_share.h"
#include "hierarchy/proposers/collapse_levels.h"
#include "simplify/simplify.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace lodestone::hierarchy {
namespace {

using prune::Crowd;

// Fewer parts than this are no crowd any more.
// Taste: a larger number ends pruning at finer levels.
constexpr size_t kFewestParts = 8;
// Parts of more triangles than this are simplified as well as thinned.
// Taste: a larger number keeps fewer parts, each with all of its triangles.
constexpr size_t kPlainPart = 12;
// The most by which the areas of parts grow.
// Taste: parts that grow more do not look like a crowd.
constexpr double kMostGrowth = 64;
// Enlarged parts hide more of each other: growth is corrected by the area that is seen, so often.
// Taste: more come nearer to the same area, for a measurement each.
constexpr int kCorrections = 3;

/// The parts and triangles that are kept at one level.
struct PruningStep {
    size_t parts;
    size_t crowd_triangles;  // after simplification
    size_t rest_triangles;
};

std::vector<PruningStep> steps_of(const Crowd& crowd, size_t rest, double ratio) {
    const bool plain = crowd.triangles <= kPlainPart * crowd.parts.size();
    std::vector<PruningStep> out;
    for (double share = ratio;; share *= ratio) {
        // Thinning and simplifying go half the way each, on a logarithmic scale.
        const double kept = plain ? share : std::sqrt(share);
        const auto of = [](double part, size_t whole) {
            return static_cast<size_t>(std::round(part * static_cast<double>(whole)));
        };
        const PruningStep step{of(kept, crowd.parts.size()), of(share, crowd.triangles),
                               of(share, rest)};
        if (step.parts < std::max(kFewestParts, crowd.slots.size()))
            return out;
        out.push_back(step);
    }
}

/// All but the crowd at each step's triangles; the mesh itself where it cannot get simpler.
std::vector<Mesh> rests_of(const Mesh& rest, const std::vector<PruningStep>& steps,
                           const Job& job) {
    std::vector<size_t> targets;
    for (const PruningStep& step : steps) {
        const size_t target = std::max(step.rest_triangles, kFewestTriangles);
        if (target < rest.triangles.size() && (targets.empty() || target < targets.back()))
            targets.push_back(target);
    }
    std::vector<Mesh> levels;
    if (!targets.empty())
        levels = simplify::simplify_chain(rest, targets, {}, job);
    std::vector<Mesh> out;
    for (const PruningStep& step : steps) {
        const Mesh* best = &rest;
        for (const Mesh& level : levels) {
            if (best->triangles.size() > std::max(step.rest_triangles, kFewestTriangles))
                best = &level;
        }
        out.push_back(*best);
    }
    return out;
}

/// Materials of the crowd's slots, if only parts use them: as different from each other as pixels
/// of the whole crowd are.
std::vector<Material> contrasted(const std::vector<Material>& materials, const Crowd& crowd,
                                 const std::set<uint16_t>& rest_slots,
                                 const std::vector<double>& visible, double variance) {
    std::vector<Material> out = materials;
    glm::dvec3 mean(0.0);
    double all = 0;
    for (size_t kind = 0; kind < crowd.slots.size(); ++kind) {
        if (crowd.slots[kind] >= materials.size())
            return out;
        mean += visible[kind] * materials[crowd.slots[kind]].base_color;
        all += visible[kind];
    }
    if (!(all > 0) || crowd.slots.size() < 2)
        return out;
    mean /= all;
    for (const uint16_t slot : crowd.slots) {
        Material& material = out[slot];
        if (rest_slots.count(slot) == 0 && !material.base_color_texture && !material.other)
            material.base_color = prune::with_contrast(material.base_color, mean, variance);
    }
    return out;
}

class CrowdPruner {
public:
    CrowdPruner(const Mesh& mesh, const Crowd& crowd, const MeasuredFinest& finest, const Job& job)
        : mesh_(mesh), crowd_(crowd), finest_(finest), job_(job) {
        std::vector<uint8_t> keep(mesh.triangles.size(), 0);
        std::vector<uint32_t> tags(mesh.triangles.size(), 0);
        for (size_t i = 0; i < keep.size(); ++i) {
            const uint32_t part = crowd.part_of[i];
            if (part != prune::kNoPart) {
                tags[i] = 1 + crowd.parts[part].kind;
                continue;
            }
            keep[i] = 1;
            rest_slots_.insert(mesh.slot(i));
        }
        rest_ = subset(mesh, keep);
        visible_ = visible_by_tag(mesh, tags, 1 + crowd.slots.size(), finest, job);
        visible_.erase(visible_.begin());
    }

    const Mesh& rest() const { return rest_; }
    /// Slots that only parts use: their colors may change.
    std::vector<uint16_t> own_slots() const {
        std::vector<uint16_t> out;
        for (const uint16_t slot : crowd_.slots) {
            if (rest_slots_.count(slot) == 0)
                out.push_back(slot);
        }
        return out;
    }

    /// With these parts kept, and the rest already simplified.
    StandInCandidate thinned(const std::vector<uint32_t>& order, const PruningStep& step,
                             const Mesh& rest) const {
        std::vector<double> growth = first_growth(order, step.parts);
        StandInCandidate out;
        for (int i = 0;; ++i) {
            prune::PrunedMesh crowd = prune::prune_crowd(mesh_, crowd_, order, step.parts, growth);
            if (crowd_.triangles > kPlainPart * crowd_.parts.size() &&
                step.crowd_triangles < crowd.mesh.triangles.size())
                simplify(crowd, step.crowd_triangles);
            // The crowd comes first, so that its kinds are the tags of the first triangles.
            Mesh level = crowd.mesh;
            if (!rest.empty())
                append(level, rest, {});
            std::vector<uint32_t> tags(level.triangles.size(), 0);
            for (size_t t = 0; t < crowd.kind_of.size(); ++t)
                tags[t] = 1 + crowd.kind_of[t];
            if (i == kCorrections ||
                correct(growth,
                        visible_by_tag_of_level(level, tags, 1 + growth.size(), finest_, job_))) {
                out.payload = std::make_shared<const Mesh>(std::move(level));
                out.materials =
                    contrasted(finest_.materials, crowd_, rest_slots_, visible_, crowd.variance);
                return out;
            }
        }
    }

private:
    std::vector<double> first_growth(const std::vector<uint32_t>& order, size_t keep) const {
        std::vector<double> all(crowd_.slots.size(), 0);
        std::vector<double> kept(crowd_.slots.size(), 0);
        for (size_t i = 0; i < order.size(); ++i) {
            const Crowd::CrowdPart& part = crowd_.parts[order[i]];
            all[part.kind] += part.area;
            if (i < std::max(keep, crowd_.slots.size()))
                kept[part.kind] += part.area;
        }
        for (size_t kind = 0; kind < all.size(); ++kind)
            all[kind] = kept[kind] > 0 ? std::clamp(all[kind] / kept[kind], 1.0, kMostGrowth) : 1;
        return all;
    }

    /// Moves growth towards what shows as much as the whole crowd; true when it does already.
    bool correct(std::vector<double>& growth, const std::vector<double>& now) const {
        // The relative difference of areas that counts as none.
        // Taste: about as much as the rays know; a larger value shows more or less than the crowd.
        constexpr double kSameArea = 0.02;
        bool right = true;
        for (size_t kind = 0; kind < growth.size(); ++kind) {
            if (!(now[kind + 1] > 0) || !(visible_[kind] > 0))
                continue;
            const double ratio = visible_[kind] / now[kind + 1];
            right = right && std::abs(ratio - 1) <= kSameArea;
            growth[kind] =
                std::clamp(growth[kind] * std::clamp(ratio, 0.5, 2.0), 0.25, kMostGrowth);
        }
        return right;
    }

    /// Kinds are told by slots, which simplification keeps.
    void simplify(prune::PrunedMesh& crowd, size_t triangles) const {
        std::vector<uint32_t> kind_of_slot;
        for (size_t kind = 0; kind < crowd_.slots.size(); ++kind) {
            kind_of_slot.resize(std::max<size_t>(kind_of_slot.size(), crowd_.slots[kind] + 1u), 0);
            kind_of_slot[crowd_.slots[kind]] = static_cast<uint32_t>(kind);
        }
        Mesh level = simplify::simplify_mesh(crowd.mesh, triangles, {}, job_);
        if (level.empty())
            return;
        crowd.mesh = std::move(level);
        crowd.kind_of.assign(crowd.mesh.triangles.size(), 0);
        for (size_t i = 0; i < crowd.kind_of.size(); ++i) {
            const uint16_t slot = crowd.mesh.slot(i);
            crowd.kind_of[i] = slot < kind_of_slot.size() ? kind_of_slot[slot] : 0;
        }
    }

    const Mesh& mesh_;
    const Crowd& crowd_;
    const MeasuredFinest& finest_;
    const Job& job_;
    Mesh rest_;
    std::set<uint16_t> rest_slots_;
    std::vector<double> visible_;  // by kind, of the whole crowd
};

/// The error from which on a pruned level is no use: any solid will do, or cards.
double error_of_enough(const std::vector<StandInCandidate>& candidates, const Mesh& mesh) {
    double out = bound_of(mesh.positions).radius;
    for (const StandInCandidate& candidate : candidates) {
        if (candidate.state == CandidateState::Pictured)
            out = std::min(out, candidate.error);
    }
    return out;
}

/// None of more than about so many triangles. Those of a `crown`, a single thing of leaf cards, are
/// twice as many, and compared finely: half of the leaves often look like all of them.
void add_pruned_levels(std::vector<StandInCandidate>& candidates, const Mesh& mesh,
                       const Crowd& crowd, bool crown, double level_ratio, size_t most,
                       const MeasuredFinest& finest, FinestPictures& pictures, const Job& job) {
    const CrowdPruner thinner(mesh, crowd, finest, job);
    const std::vector<PruningStep> steps = steps_of(crowd, thinner.rest().triangles.size(),
                                                    crown ? std::sqrt(level_ratio) : level_ratio);
    const std::vector<Mesh> rests = rests_of(thinner.rest(), steps, job);
    const std::vector<uint16_t> own = thinner.own_slots();
    const double far = error_of_enough(candidates, mesh);
    std::vector<prune::PruneOrder> orders{prune::PruneOrder::Random};
    if (crowd.sizes_differ())
        orders.push_back(prune::PruneOrder::Largest);
    bool alike = false;  // of a crown that was thinned at random
    for (const prune::PruneOrder kind : orders) {
        if (alike)
            break;  // the largest leaves are no nearer: they lie closer together
        const std::vector<uint32_t> order = prune::prune_order(crowd, kind, finest.options.seed);
        for (size_t i = 0; i < steps.size(); ++i) {
            job.check();
            if (steps[i].crowd_triangles + rests[i].triangles.size() > most)
                continue;
            StandInCandidate candidate = thinner.thinned(order, steps[i], rests[i]);
            if (candidate.mesh().triangles.size() >= mesh.triangles.size())
                continue;
            compare_pictures(candidate, own, finest, pictures, job);
            if (crown && agrees_everywhere(candidate, finest, pictures)) {
                compare_finely(candidate, own, finest, pictures, job);
                alike = true;
            }
            const bool enough = candidate.error >= far;
            candidates.push_back(std::move(candidate));
            if (enough)
                break;
        }
    }
}

}  // namespace

void propose_pruned_levels(ProposalRound& round) {
    const ReplacedObject& whole = round.limits.whole;
    if (round.crowd.empty())
        return;
    const bool dear = bytes_within(round.candidates, kNear * whole.bound.radius, whole.uses,
                                   whole.costs) > kCollapsed * whole.bytes;
    round.pruned = whole.many || is_foliage(round.crowd) || dear;
    if (!round.pruned)
        return;
    round.by_pictures = true;
    round.pictures.take(round.limits.mesh, measure::AgreementReference::kSide, round.job);
    const bool crown = !round.finest.options.group && round.finest.scene().see_through();
    add_pruned_levels(round.candidates, round.limits.mesh, round.crowd, crown,
                      round.limits.level_ratio, triangles_for(whole.most, whole.uses, whole.costs),
                      round.finest, round.pictures, round.job);
}

}  // namespace lodestone::hierarchy
