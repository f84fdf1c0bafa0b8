// SPDX-License-Identifier: GPL-3.0-or-later
#include "approximate/pass.h"

#include "approximate/sheets.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace lodestone::approximate {
namespace {

/// Of the live triangles, how many one pass may take. Smaller passes choose with fresher costs.
constexpr double kShare = 0.25;
/// A careful pass stops at this many times the cost at which its edges would suffice: some of them
/// turn out to be barred by their neighbors.
constexpr double kSlack = 1.3;
/// A pass that takes less than this share of what is wanted is worth trying harder.
constexpr double kSlow = 0.02;
constexpr int kMostSlowPasses = 64;
/// Triangles a pass may look at for each one there is; ordinary meshes need 18 at most.
constexpr size_t kWork = 40;

bool is_slow(size_t gone, size_t wanted) {
    return static_cast<double>(gone) < kSlow * static_cast<double>(wanted);
}

/// Sorts order by key, stable. The lowest 10 of 32 bits are ignored: for positive floats that is
/// 0.02 % of the value.
void radix_sort(std::vector<uint32_t>& keys, std::vector<uint32_t>& order,
                std::vector<uint32_t>& keys_spare, std::vector<uint32_t>& order_spare) {
    keys_spare.resize(keys.size());
    order_spare.resize(order.size());
    for (const unsigned shift : {10u, 21u}) {
        std::array<uint32_t, 2049> first{};
        for (const uint32_t key : keys)
            ++first[((key >> shift) & 2047u) + 1];
        for (size_t i = 0; i < 2048; ++i)
            first[i + 1] += first[i];
        for (size_t i = 0; i < keys.size(); ++i) {
            const uint32_t to = first[(keys[i] >> shift) & 2047u]++;
            keys_spare[to] = keys[i];
            order_spare[to] = order[i];
        }
        keys.swap(keys_spare);
        order.swap(order_spare);
    }
}

}  // namespace

void Reducer::rank(Effort effort, const Job& job) {
    keys_.clear();
    order_.clear();
    for (size_t i = 0; i < edges_.size(); ++i) {
        if ((i & 0xffffu) == 0)
            job.check();
        const Edge& edge = edges_[i];
        if (!edges_.allowed(edge, effort))
            continue;
        const auto cost = static_cast<float>(edges_.optimum(mesh_, edge, effort).cost);
        if (!std::isfinite(cost))
            continue;
        keys_.push_back(std::bit_cast<uint32_t>(cost));
        order_.push_back(static_cast<uint32_t>(i));
    }
    radix_sort(keys_, order_, keys_spare_, order_spare_);
}

size_t Reducer::pass(size_t target, Effort effort, const Job& job) {
    const size_t before = mesh_.live;
    if (effort == Effort::Anything)
        drop_copies(mesh_);
    compact(mesh_);
    if (mesh_.live <= target)
        return before - mesh_.live;
    adjacency_.build(mesh_);
    edges_.build(mesh_, adjacency_, options_, job);
    parts_.measure(mesh_, options_.part_weight);
    rank(effort, job);

    const size_t start = mesh_.live;
    const auto share = static_cast<size_t>(kShare * static_cast<double>(start));
    const size_t want = std::min(start - target, std::max<size_t>(share, 64));
    uint32_t limit = ~uint32_t{0};
    if (effort == Effort::Careful && want / 2 < keys_.size())
        limit = std::bit_cast<uint32_t>(static_cast<float>(kSlack) *
                                        std::bit_cast<float>(keys_[want / 2]));

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
    for (size_t i = 0; i < order_.size() && gone < want && keys_[i] <= limit; ++i) {
        if ((i & 0xfffu) == 0)
            job.check();
        if (collapser.work() > most_work)
            break;
        const auto cost = static_cast<double>(std::bit_cast<float>(keys_[i]));
        while (next_part < removable.size() && removable[next_part].cost < cost && gone < want)
            remove_next_part();
        const Edge& edge = edges_[order_[i]];
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
