// SPDX-License-Identifier: GPL-3.0-or-later
#include "approximate/pass.h"

#include "approximate/edge_costs.h"
#include "approximate/sheets.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace lodestone::approximate {
namespace {

/// A pass that takes less than this share of what is wanted is worth trying harder.
constexpr double kSlow = 0.02;
constexpr int kMostSlowPasses = 64;
/// Triangles a pass may look at for each one there is; ordinary meshes need 18 at most.
constexpr size_t kWork = 40;

/// Small passes choose with fresher costs, large ones take less time.
constexpr Pace kFast{0.35, 2.0, 1.0 / 3, 22};
constexpr Pace kBest{0.12, 1.0, 0.5, 22};

bool is_slow(size_t gone, size_t wanted) {
    return static_cast<double>(gone) < kSlow * static_cast<double>(wanted);
}

/// The candidates by cost, those of almost the same one as they come: neighbors in the mesh, which
/// the processor's caches know, mostly follow each other.
void sort(const std::vector<Candidate>& candidates, unsigned shift, std::vector<uint32_t>& order) {
    std::vector<uint32_t> first((kImpossible >> shift) + 2, 0);
    for (const Candidate& candidate : candidates)
        ++first[(candidate.key >> shift) + 1];
    for (size_t i = 1; i < first.size(); ++i)
        first[i] += first[i - 1];
    order.resize(candidates.size());
    for (uint32_t i = 0; i < candidates.size(); ++i)
        order[first[candidates[i].key >> shift]++] = i;
}

}  // namespace

Reducer::Reducer(CollapseMesh& mesh, const SimplifyOptions& options)
    : mesh_(mesh), options_(options), pace_(options.mode == SimplifyMode::Best ? kBest : kFast) {}

size_t Reducer::pass(size_t target, Effort effort, const Job& job) {
    const size_t before = mesh_.live;
    if (effort == Effort::Anything)
        drop_copies(mesh_);
    compact(mesh_);
    if (mesh_.live <= target)
        return before - mesh_.live;
    adjacency_.build(mesh_);
    edges_.build(mesh_, adjacency_, options_, job);
    if (!begun_) {
        edges_.borders([&](uint32_t a, uint32_t b) {
            mesh_.outline.emplace_back(mesh_.ids[a], mesh_.ids[b]);
        });
    }
    begun_ = true;
    parts_.measure(mesh_, options_.part_weight);
    edges_.rank(mesh_, effort, job);

    const size_t start = mesh_.live;
    const auto share = static_cast<size_t>(pace_.share * static_cast<double>(start));
    const size_t want = std::min(start - target, std::max<size_t>(share, 64));
    uint32_t limit = kImpossible - 1;
    const auto enough = static_cast<size_t>(pace_.quantile * static_cast<double>(want));
    if (effort == Effort::Careful && enough < edges_.possible())
        limit =
            std::min(limit, std::bit_cast<uint32_t>(static_cast<float>(pace_.slack) *
                                                    std::bit_cast<float>(edges_.key_of(enough))));
    edges_.take(limit, candidates_);
    sort(candidates_, pace_.shift, order_);

    Collapser collapser(mesh_, adjacency_, effort, options_.max_turn);
    used_.assign(mesh_.points.size(), 0);
    const std::vector<Part>& removable = parts_.removable();
    std::vector<uint8_t> doomed(removable.empty() ? 0 : mesh_.part_count, 0);
    std::vector<size_t> taken(doomed.size(), 0);
    size_t next_part = 0;
    size_t gone = 0;
    const auto remove_next_part = [&] {
        const Part& part = removable[next_part++];
        doomed[part.part] = 1;
        gone += part.triangles - taken[part.part];
    };
    const size_t most_work = kWork * start + 100000;
    for (size_t i = 0; i < order_.size() && gone < want; ++i) {
        if ((i & 0xfffu) == 0)
            job.check();
        if (collapser.work() > most_work)
            break;
        const Candidate& candidate = candidates_[order_[i]];
        const auto cost = static_cast<double>(std::bit_cast<float>(candidate.key));
        while (next_part < removable.size() && removable[next_part].cost < cost && gone < want)
            remove_next_part();
        const Edge& edge = candidate.edge;
        if (gone >= want || used_[edge.a] || used_[edge.b])
            continue;
        const uint32_t part = mesh_.parts[edge.a];
        if (!doomed.empty() && doomed[part])
            continue;
        const Optimum best = edges_.optimum(mesh_, edge, effort);
        edges_.other_points(mesh_, edge, effort, other_points_);
        const size_t went = collapser.collapse(edge.a, edge.b, best.point, other_points_);
        if (went == 0)
            continue;
        used_[edge.a] = used_[edge.b] = 1;
        gone += went;
        if (!taken.empty())
            taken[part] += went;
    }
    if (effort >= Effort::Topology && is_slow(gone, want)) {
        while (gone < want && next_part < removable.size())
            remove_next_part();
    }
    if (next_part > 0)
        parts_.remove(mesh_, doomed);
    return before - start + gone;
}

bool Reducer::reduce(size_t target, const Job& job, const std::function<void()>& after_pass) {
    Effort effort = Effort::Careful;
    int slow_passes = 0;
    while (mesh_.live > target) {
        const size_t wanted = mesh_.live - target;
        const size_t gone = pass(target, effort, job);
        after_pass();
        if (!is_slow(gone, wanted))
            continue;
        if (effort < Effort::Anything)
            effort = static_cast<Effort>(static_cast<int>(effort) + 1);
        else if (gone == 0 || ++slow_passes > kMostSlowPasses)
            break;
    }
    compact(mesh_);
    return mesh_.live <= target;
}

}  // namespace lodestone::approximate
