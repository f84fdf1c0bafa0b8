// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/collapse/collapse_pass.h"

#include "base/parallel.h"
#include "simplify/collapse/edge_costs.h"
#include "simplify/collapse/mesh_tunnels.h"
#include "simplify/collapse/split_touching.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

namespace lodestone::simplify {
namespace {

/// The share of the wanted triangles below which a pass counts as slow and the next one tries
/// harder.
/// Taste: a larger share tries harder sooner, with more error.
constexpr double kSlow = 0.02;
// The most slow passes to a target.
// Taste: more reach more targets on strange meshes, in more time.
constexpr int kMostSlowPasses = 64;
/// The triangles that a pass may visit for each one of the mesh.
/// Taste: ordinary meshes need 18 at most; less would end passes of hubs too early.
constexpr size_t kWork = 40;

/// The limits of passes: small ones choose with fresher costs, large ones take less time. A share
/// above 0.35 ruins plates with holes, even far from the target: all flat edges go in one pass,
/// then round ones.
/// Fitted: by tests/bench/peers/bench_simplify.py, nine shared models at four targets.
constexpr PassLimits kPace{0.35, 2.0, 1.0 / 3, 6};
/// From this many times the target's triangles on, a pass may take dearer edges: triangles twice as
/// large cost eight times as much, so such costs are small beside those to come.
/// Fitted: by tests/bench/peers/bench_simplify.py, nine shared models at four targets.
constexpr double kFar = 4;
double slack_far(double times, double most) {
    return std::clamp(std::pow(times / kFar, 1.5), 1.0, most);
}
/// A last pass that wants less than this share of the triangles gets kRestReach times more
/// candidates: the few it needs could all be impossible, and another pass prices every edge again.
/// Fitted: by tests/bench/peers/bench_simplify.py, nine shared models at four targets.
constexpr double kRest = 0.05;
// Fitted: by tests/bench/peers/bench_simplify.py, nine shared models at four targets.
constexpr double kRestReach = 4;
/// The rounds of a pass. Chunks go through their candidates at the same time, in rounds of rising
/// costs, so that the dearest edges of one chunk do not go before cheaper ones of another.
/// Taste: more rounds keep the order of costs better and visit all chunks more often.
constexpr size_t kRounds = 4;
// One round is enough where less than this share of the candidates' triangles is wanted, because
// the pass will run out of candidates.
// Taste: a smaller share takes one round more often, and less time.
constexpr double kGone = 0.8;
/// A pass that removes less than this share of what it wants was given too few candidates.
/// Taste: a larger share gives more candidates sooner, which are priced in vain.
constexpr double kPoor = 0.35;
/// The candidates that a chunk holds for each of its vertices, the cheapest. If it held all within
/// the limit, chunks with a plain surface would go before dearer ones do. kHeld is enough for any
/// share as long as most candidates can be collapsed; kMostHeld is for where they cannot.
/// Fitted: by tests/bench/peers/bench_simplify.py, error and CPU of nine shared models (before: 2).
constexpr double kHeld = 1.15;
// Taste: more hold more memory and let plain chunks go first.
constexpr double kMostHeld = 2;
/// How many edges ahead memory is asked for: for their lists, then for their triangles.
/// Taste: more displace what is still needed, fewer come too late.
constexpr size_t kLists = 12;
// Taste: more displace what is still needed, fewer come too late.
constexpr size_t kTriangles = 4;

double cost_of_key(uint32_t key) {
    return static_cast<double>(std::bit_cast<float>(key));
}

bool is_slow(size_t gone, size_t wanted) {
    return static_cast<double>(gone) < kSlow * static_cast<double>(wanted);
}

uint32_t step_of(const CollapseCandidate& candidate) {
    return candidate.key >> kKeyShift;
}

/// The keys at which rounds end, so that each has the same number of candidates, as nearly as keys
/// allow. Parts up to the limit count, too: a round begins by removing those that are cheaper than
/// all its edges.
std::vector<uint32_t> rounds_of(const std::vector<EdgeChunk>& chunks,
                                const std::vector<CollapsePart>& removable, uint32_t limit,
                                size_t want) {
    std::vector<size_t> counts((kImpossible >> kKeyShift) + 1, 0);
    size_t all = 0;
    for (const CollapsePart& part : removable) {
        const uint32_t key = key_of_cost(static_cast<float>(part.cost));
        if (key > limit)
            break;
        ++counts[key >> kKeyShift];
        ++all;
    }
    for (const EdgeChunk& chunk : chunks) {
        for (const CollapseCandidate& candidate : chunk.candidates)
            ++counts[step_of(candidate)];
        all += chunk.candidates.size();
    }
    const bool all_go = kGone * static_cast<double>(all) < static_cast<double>(want);
    const size_t rounds = chunks.size() > 1 && !all_go ? kRounds : 1;
    std::vector<uint32_t> ends;
    size_t sum = 0;
    for (uint32_t step = 0; step < counts.size(); ++step) {
        sum += counts[step];
        if (sum > 0 && sum * rounds >= all * (ends.size() + 1) && counts[step] > 0)
            ends.push_back(step + 1);
    }
    return ends;
}

}  // namespace

CollapseReducer::CollapseReducer(CollapseMesh& mesh, const SimplifyOptions& options)
    : mesh_(mesh), options_(options), pace_(kPace) {}

/// One batch of collapses.
class CollapseReducer::CollapseBatch {
public:
    CollapseBatch(CollapseReducer& reducer, CollapseEffort effort, size_t start, size_t want,
                  uint32_t limit)
        : r_(reducer),
          effort_(effort),
          limit_(limit),
          want_(want),
          work_(kWork * start + 100000),
          removable_(reducer.parts_.removable()),
          doomed_(removable_.empty() ? 0 : reducer.mesh_.part_count, 0),
          taken_(doomed_.size(), 0),
          whole_(reducer.mesh_, reducer.adjacency_, reducer.edges_, effort,
                 reducer.options_.max_turn) {
        r_.used_.assign(r_.mesh_.points.size(), 0);
    }

    void run(const Job& job) {
        const std::vector<EdgeChunk>& chunks = r_.edges_.chunks();
        std::vector<size_t> next(chunks.size(), 0);  // the next candidate of each chunk
        std::vector<size_t> last(chunks.size(), 0);  // the end of the round in each chunk
        std::vector<std::vector<uint32_t>> left(chunks.size());
        std::vector<size_t> gone(chunks.size(), 0);
        uint32_t begin = 0;
        const std::vector<uint32_t> rounds = rounds_of(chunks, removable_, limit_, want_);
        for (const uint32_t end : rounds) {
            if (gone_ >= want_)
                break;
            remove_parts_below(begin << kKeyShift);
            begin = end;
            size_t all = 0;
            for (size_t i = 0; i < chunks.size(); ++i) {
                const std::vector<CollapseCandidate>& candidates = chunks[i].candidates;
                last[i] = next[i];
                while (last[i] < candidates.size() && step_of(candidates[last[i]]) < end)
                    ++last[i];
                all += last[i] - next[i];
            }
            const size_t rest = want_ - std::min(want_, gone_);
            if (chunks.size() == 1) {
                for (uint32_t k = 0; k < last[0]; ++k)
                    left[0].push_back(k);
            } else {
                parallel_for(chunks.size(), [&](size_t i) {
                    job.check();
                    left[i].clear();
                    const double part = static_cast<double>(last[i] - next[i]) /
                                        static_cast<double>(std::max<size_t>(all, 1));
                    const auto share = [&](size_t whole) {
                        return static_cast<size_t>(part * static_cast<double>(whole));
                    };
                    gone[i] = within(chunks[i], next[i], last[i], share(rest),
                                     share(work_ / rounds.size()), left[i]);
                });
                for (const size_t each : gone) {
                    gone_ += each;
                    collapsed_ += each;
                }
            }
            across(chunks, left, job);
            next = last;
        }
        if (effort_ == CollapseEffort::Careful && gone_ == 0) {
            // No edge within the limit can be collapsed: parts go before dearer edges do.
            limit_ = kImpossible - 1;
            r_.parts_.locate(r_.mesh_, cost_of_key(limit_), next_part_, job);
            const std::vector<uint32_t> all = rounds_of(chunks, removable_, limit_, want_);
            if (all.size() > 1)
                remove_parts_below(all[all.size() - 2] << kKeyShift);
        }
        if (effort_ >= CollapseEffort::Topology && is_slow(gone_, want_)) {
            while (gone_ < want_ && next_part_ < removable_.size())
                remove_next_part();
        }
        r_.mesh_.live -= collapsed_;
        if (next_part_ > 0)
            r_.parts_.remove(r_.mesh_, doomed_);
    }

private:
    void remove_next_part() {
        const CollapsePart& part = removable_[next_part_++];
        doomed_[part.part] = 1;
        gone_ += part.triangles - taken_[part.part];
    }
    void remove_parts_below(uint32_t key) {
        const double cost = cost_of_key(std::min(key, limit_));
        while (next_part_ < removable_.size() && removable_[next_part_].cost < cost &&
               gone_ < want_)
            remove_next_part();
    }
    size_t collapse(EdgeCollapser& collapser, const CollapseCandidate& candidate) {
        const uint32_t part = r_.mesh_.parts[candidate.a];
        if (!doomed_.empty() && doomed_[part])
            return 0;
        const size_t went = collapser.collapse(candidate);
        if (went == 0 || went == EdgeCollapser::kOutside)
            return went;
        r_.used_[candidate.a] = r_.used_[candidate.b] = 1;
        if (!taken_.empty())
            std::atomic_ref(taken_[part]).fetch_add(went, std::memory_order_relaxed);
        return went;
    }

    /// Collapses the candidates of a chunk from `next` to `last` that can be judged by themselves,
    /// until `most` triangles are removed; `left` gets the others.
    size_t within(const EdgeChunk& chunk, size_t next, size_t last, size_t most, size_t work,
                  std::vector<uint32_t>& left) {
        if (next == last)
            return 0;
        EdgeCollapser collapser(r_.mesh_, r_.adjacency_, r_.edges_, effort_, r_.options_.max_turn,
                                &chunk);
        size_t gone = 0;
        for (size_t k = next; k < last; ++k) {
            const CollapseCandidate& candidate = chunk.candidates[k];
            if (k + kLists < last)
                collapser.prefetch_lists(chunk.candidates[k + kLists]);
            if (k + kTriangles < last) {
                const CollapseCandidate& coming = chunk.candidates[k + kTriangles];
                if (!r_.used_[coming.a])
                    collapser.prefetch_triangles(coming);
            }
            if (r_.used_[candidate.a])
                continue;
            if (!chunk.has(candidate.b) || gone + 2 > most || collapser.work() > work) {
                left.push_back(static_cast<uint32_t>(k));
                continue;
            }
            if (r_.used_[candidate.b])
                continue;
            const size_t went = collapse(collapser, candidate);
            if (went == EdgeCollapser::kOutside)
                left.push_back(static_cast<uint32_t>(k));
            else
                gone += went;
        }
        return gone;
    }

    /// Collapses the candidates that the chunks left, one after the other.
    void across(const std::vector<EdgeChunk>& chunks,
                const std::vector<std::vector<uint32_t>>& left, const Job& job) {
        for (size_t i = 0; i < chunks.size(); ++i) {
            for (size_t n = 0; n < left[i].size(); ++n) {
                if ((n & 0xfffu) == 0)
                    job.check();
                const std::vector<CollapseCandidate>& candidates = chunks[i].candidates;
                const CollapseCandidate& candidate = candidates[left[i][n]];
                if (n + kLists < left[i].size())
                    whole_.prefetch_lists(candidates[left[i][n + kLists]]);
                if (n + kTriangles < left[i].size())
                    whole_.prefetch_triangles(candidates[left[i][n + kTriangles]]);
                if (r_.used_[candidate.a] || r_.used_[candidate.b])
                    continue;
                remove_parts_below(candidate.key);
                if (gone_ >= want_ || whole_.work() > work_)
                    return;
                const size_t went = collapse(whole_, candidate);
                gone_ += went;
                collapsed_ += went;
            }
        }
    }

    CollapseReducer& r_;
    CollapseEffort effort_;
    uint32_t limit_;  // the key that no removed part exceeds
    size_t want_;
    size_t work_;  // the triangles it may visit
    const std::vector<CollapsePart>& removable_;
    std::vector<uint8_t> doomed_;
    std::vector<size_t> taken_;
    EdgeCollapser whole_;
    size_t next_part_ = 0;
    size_t gone_ = 0;       // removed triangles, those of parts included
    size_t collapsed_ = 0;  // without those of parts
};

size_t CollapseReducer::pass(size_t target, CollapseEffort effort, const Job& job) {
    const size_t before = mesh_.live;
    if (effort == CollapseEffort::Anything)
        drop_copies(mesh_);
    if (begun_ || effort == CollapseEffort::Anything)
        compact(mesh_, &adjacency_);
    if (mesh_.live <= target)
        return before - mesh_.live;
    edges_.build(mesh_, adjacency_, options_, !begun_, job);
    if (!begun_) {
        for (const EdgeChunk& chunk : edges_.chunks()) {
            for (const auto& [a, b] : chunk.borders)
                mesh_.outline.emplace_back(mesh_.ids[a], mesh_.ids[b]);
        }
    }
    if (!options_.keep_topology) {
        if (cut_)
            find_parts(mesh_);
        if (measured_ && !cut_)
            parts_.count(mesh_);
        else
            parts_.measure(mesh_, options_.part_weight);
        measured_ = true;
        cut_ = false;
    }
    begun_ = true;

    const size_t start = mesh_.live;
    const auto share = static_cast<size_t>(pace_.share * static_cast<double>(start));
    const size_t want = std::min(start - target, std::max<size_t>(share, 64));
    uint32_t limit = kImpossible - 1;
    if (effort == CollapseEffort::Careful) {
        const auto live = static_cast<double>(start);
        const auto wanted = static_cast<double>(want);
        const bool rest = want == start - target && wanted < kRest * live;
        const double quantile = (rest ? kRestReach : 1) * reach_ * pace_.quantile;
        const uint32_t key =
            edges_.key_of(mesh_, adjacency_, effort, static_cast<size_t>(quantile * wanted));
        const double slack =
            pace_.slack * slack_far(live / static_cast<double>(target), pace_.most_slack);
        limit = std::min(
            limit, std::bit_cast<uint32_t>(static_cast<float>(slack) * std::bit_cast<float>(key)));
    }
    // Edges with more than two triangles then either are the input's and stay, or may all be cut.
    if (effort >= CollapseEffort::Topology && !asked_) {
        asked_ = true;
        loops_ = !has_tunnels(mesh_, adjacency_);
    }
    const bool usual = effort == CollapseEffort::Careful && reach_ == 1;
    parts_.locate(mesh_, cost_of_key(limit), 0, job);
    edges_.take(mesh_, adjacency_, effort, limit, usual ? kHeld : kMostHeld, job);
    CollapseBatch(*this, effort, start, want, limit).run(job);
    if (effort >= CollapseEffort::Topology)
        cut_ = cut_tunnels(mesh_, loops_);
    // Where most candidates cannot be collapsed, more are taken: otherwise each pass prices the
    // same ones again.
    const auto yield = static_cast<double>(start - mesh_.live) / static_cast<double>(want);
    reach_ = yield < kPoor ? 2 * reach_ : std::max(1.0, reach_ / 2);
    return before - mesh_.live;
}

bool CollapseReducer::reduce(size_t target, const Job& job, const std::function<void()>& after_pass,
                             Adjacency& adjacency) {
    const CollapseEffort last =
        options_.keep_topology ? CollapseEffort::Rough : CollapseEffort::Anything;
    CollapseEffort effort = CollapseEffort::Careful;
    int slow_passes = 0;
    adjacency_ = std::move(adjacency);
    measured_ = false;
    while (mesh_.live > target) {
        const size_t wanted = mesh_.live - target;
        const size_t gone = pass(target, effort, job);
        after_pass();
        if (!is_slow(gone, wanted))
            continue;
        if (effort < last)
            effort = static_cast<CollapseEffort>(static_cast<int>(effort) + 1);
        else if (gone == 0 || ++slow_passes > kMostSlowPasses)
            break;
    }
    edges_.clear();
    used_ = {};
    adjacency_ = {};
    compact(mesh_, &adjacency);
    shrink(mesh_);
    return mesh_.live <= target;
}

}  // namespace lodestone::simplify
