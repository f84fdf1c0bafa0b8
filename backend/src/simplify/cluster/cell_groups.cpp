// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/cluster/cell_groups.h"

#include "simplify/cluster/cell_merge.h"
#include "simplify/cluster/cell_tree.h"

#include <algorithm>
#include <span>

namespace lodestone::simplify {
namespace {

// The budget and the costs of merging across grid lines, which gives less error but takes longer
// than the tree: nanoseconds for each triangle of the input, for each cell it begins with, and for
// each it merges.
// Fitted: by tests/bench/peers/bench_simplify.py, 36 pairs: 0.6 of simplifySloppy's error.
constexpr double kMergeBudget = 4;
// Fitted: to measured times of this step (nanoseconds); the script was not kept.
constexpr double kBeginCost = 135;
// Fitted: to measured times of this step (nanoseconds); the script was not kept.
constexpr double kMergeCost = 600;
// The most cells to begin with, for each cell that is left.
// Taste: more give less error and take longer.
constexpr double kMostMerged = 3;
// The share of the target from which on the tree's tries end.
// Fitted: by tests/bench/peers/bench_simplify.py, 36 pairs; a larger share takes more tries.
constexpr double kNear = 0.95;
// The share that is enough when copies were left out.
// Taste: nearer takes more rounds of grouping.
constexpr double kEnough = 0.94;
// The most tries of the tree for one goal.
// Taste: more come nearer to the target, more slowly.
constexpr int kTries = 12;
// The most goals for one target.
// Taste: more come nearer to the target where many copies are left out.
constexpr int kGoals = 4;

bool differ(const Triangle& t) {
    return (t.x != t.y) & (t.y != t.z) & (t.z != t.x);
}

size_t count_of(std::span<const Triangle> triangles, std::span<const uint32_t> now) {
    size_t count = 0;
    for (const Triangle& t : triangles)
        count += differ({now[t.x], now[t.y], now[t.z]}) ? 1 : 0;
    return count;
}

/// The set of a growing list of triangles, however they are turned.
class TriangleSet {
public:
    explicit TriangleSet(size_t most) {
        while (size_ < most)
            size_ *= 2;
        heads_.assign(size_, kNoCell);
        entries_.reserve(most);
    }
    bool add(const Triangle& t) {
        const uint32_t low = std::min({t.x, t.y, t.z});
        const uint32_t high = std::max({t.x, t.y, t.z});
        const uint32_t middle = t.x ^ t.y ^ t.z ^ low ^ high;
        // Triangles of neighbors are near to each other in the table, and those around one vertex
        // apart.
        const uint32_t spot = (middle * 0x85ebca6bu ^ high * 0xc2b2ae35u) >> (32u - kSpots);
        uint32_t& head = heads_[(2 * low + spot) & (size_ - 1)];
        for (uint32_t i = head; i != kNoCell; i = entries_[i].next) {
            const TriangleEntry& entry = entries_[i];
            if (entry.low == low && entry.middle == middle && entry.high == high)
                return false;
        }
        entries_.push_back({low, middle, high, head});
        head = static_cast<uint32_t>(entries_.size() - 1);
        return true;
    }

private:
    // The bits of a triangle's spot.
    // Taste: more bits spread the triangles of a vertex wider over the cache.
    static constexpr unsigned kSpots = 12;
    struct TriangleEntry {
        uint32_t low, middle, high;
        uint32_t next;
    };
    size_t size_ = 64;
    ScratchVector<uint32_t> heads_;
    ScratchVector<TriangleEntry> entries_;
};

CellGroups grouped(const GridCells& cells, ScratchVector<uint32_t> group) {
    CellGroups out;
    out.group = std::move(group);
    out.triangles.resize(cells.triangles.size() + 1);
    out.sources.resize(cells.triangles.size() + 1);
    size_t count = 0;
    // Without a branch, as half of them go.
    for (size_t i = 0; i < cells.triangles.size(); ++i) {
        const Triangle& t = cells.triangles[i];
        const Triangle of(out.group[t.x], out.group[t.y], out.group[t.z]);
        out.triangles[count] = of;
        out.sources[count] = cells.sources[i];
        count += differ(of) ? 1 : 0;
    }
    TriangleSet once(count);
    size_t kept = 0;
    for (size_t i = 0; i < count; ++i) {
        const Triangle of = out.triangles[i];
        if (!once.add(of))
            continue;
        out.triangles[kept] = of;
        out.sources[kept] = out.sources[i];
        ++kept;
    }
    out.triangles.resize(kept);
    out.sources.resize(kept);
    return out;
}

/// The grouping by the tree nearest below `wanted` triangles that it finds in a few tries; when
/// there is none, one above. `left`: how many cells to try first (0: unknown), and then how many it
/// has.
ScratchVector<uint32_t> joined(const GridCells& cells, CellTree& tree, double wanted, double near,
                               size_t& count, size_t& left) {
    size_t few = 1;  // cells that give too few triangles, and the number of these
    size_t few_triangles = 0;
    size_t many = cells.count();
    size_t many_triangles = cells.triangles.size();
    ScratchVector<uint32_t> best;
    bool best_within = false;
    size_t next = left;
    count = 0;
    const auto take = [&](size_t cells_left) {
        const std::span<const uint32_t> now = tree.joined(cells_left);
        const size_t found = count_of(cells.triangles, now);
        const bool within = static_cast<double>(found) <= wanted;
        const bool better =
            within ? !best_within || found > count : !best_within && (count == 0 || found < count);
        if (found > 0 && better) {
            best.assign(now.begin(), now.end());
            best_within = within;
            count = found;
            left = cells_left;
        }
        return found;
    };
    if (static_cast<double>(many_triangles) <= wanted) {
        take(many);
        return best;
    }
    for (int i = 0; i < kTries && many - few > 1; ++i) {
        // The number of triangles is nearly proportional to the cells; halving ensures an end.
        double part = (0.5 + 0.5 * near) * wanted - static_cast<double>(few_triangles);
        part /= static_cast<double>(std::max<size_t>(many_triangles - few_triangles, 1));
        if (i >= 6)
            part = 0.5;
        const auto step = static_cast<size_t>(part * static_cast<double>(many - few));
        const size_t tried = std::clamp(next > 0 ? next : few + step, few + 1, many - 1);
        const size_t found = take(tried);
        next = 0;
        if (static_cast<double>(found) > wanted) {
            many = tried;
            many_triangles = found;
            continue;
        }
        if (static_cast<double>(found) >= near * wanted)
            break;
        few = tried;
        few_triangles = found;
    }
    if (best.empty())  // fewer cells give no triangles at all
        take(many);
    return best;
}

/// Merges groups until at most `wanted` triangles are left.
CellGroups merged(const GridCells& cells, const CellGroups& start, size_t nodes, size_t wanted,
                  const Job& job) {
    // Numbers without gaps for the cells that triangles use; the last number is for all other
    // cells.
    ScratchVector<uint32_t> number(nodes, kNoCell);
    uint32_t count = 0;
    ScratchVector<Triangle> triangles = start.triangles;
    for (Triangle& t : triangles) {
        for (int i = 0; i < 3; ++i) {
            if (number[t[i]] == kNoCell)
                number[t[i]] = count++;
            t[i] = number[t[i]];
        }
    }
    ScratchVector<CellQuadric> quadrics(count);
    for (size_t i = 0; i < cells.count(); ++i) {
        uint32_t& of = number[start.group[i]];
        if (of == kNoCell)
            of = count;
        else if (of != count)
            quadrics[of].gather(cells.quadrics[i]);
    }
    CellMerge merge(quadrics, triangles);
    for (size_t left = triangles.size(); left > wanted;) {
        // A merged cell removes two triangles, more where thin parts become one sheet: doing most
        // of the way each time comes near without going too far.
        const size_t above = left - wanted;
        const double cells_each =
            std::min(0.5, static_cast<double>(merge.count()) / static_cast<double>(left));
        const size_t steps =
            above <= wanted / 32
                ? (above + 1) / 2
                : static_cast<size_t>(0.7 * cells_each * static_cast<double>(above)) + 1;
        const size_t before = merge.count();
        merge.merge_to(before - std::min(before - 1, steps), job);
        TriangleSet once(left);
        size_t kept = 0;
        for (const Triangle& t : triangles) {
            const Triangle of(merge.whole(t.x), merge.whole(t.y), merge.whole(t.z));
            if (differ(of) && once.add(of))
                triangles[kept++] = of;
        }
        if (kept == 0)
            return start;  // nothing would be left
        triangles.resize(kept);
        left = kept;
        if (merge.count() == before)
            break;
    }
    ScratchVector<uint32_t> group(cells.count());
    for (size_t i = 0; i < group.size(); ++i) {
        const uint32_t of = number[start.group[i]];
        group[i] = of == count ? count : merge.whole(of);
    }
    CellGroups out = grouped(cells, std::move(group));
    out.scattered = true;
    return out;
}

}  // namespace

GroupingPlan::GroupingPlan(size_t triangles, size_t target) {
    const double wanted = 0.5 * static_cast<double>(target);  // the cells of a closed surface
    const double removed =
        std::min((kMergeBudget * static_cast<double>(triangles) - kBeginCost * wanted) /
                     (kBeginCost + kMergeCost),
                 (kMostMerged - 1) * wanted);
    merges = removed > 0.2 * wanted;
    if (merges)
        begin += removed / wanted;
}

CellGroups group_cells(const GridCells& cells, const GroupingPlan& plan, size_t target,
                       const Job& job) {
    CellTree tree(cells);
    job.check();
    const auto wanted = static_cast<double>(target);
    CellGroups best;
    size_t count = 0;
    size_t left = 0;
    if (plan.merges) {
        ScratchVector<uint32_t> group = joined(cells, tree, plan.begin * wanted, 0.9, count, left);
        best = grouped(cells, std::move(group));
        return best.triangles.size() > target ? merged(cells, best, tree.nodes(), target, job)
                                              : best;
    }
    double goal = wanted;
    double too_few = 0;   // goals that left too few triangles, and too many
    double too_many = 0;  // 0: none yet
    for (int i = 0; i < kGoals; ++i) {
        ScratchVector<uint32_t> group = joined(cells, tree, goal, kNear, count, left);
        CellGroups found = grouped(cells, std::move(group));
        const size_t kept = found.triangles.size();
        const bool within = kept <= target;
        if (best.triangles.empty() || (within && kept > best.triangles.size()))
            best = std::move(found);
        if (kept == 0 || (within && static_cast<double>(kept) >= kEnough * wanted) ||
            (within && count >= cells.triangles.size()) || (!within && too_few == 0))
            break;
        // Triangles that existed twice have made room for others.
        (within ? too_few : too_many) = goal;
        const double before = goal;
        goal = too_many > 0 ? 0.5 * (too_few + too_many)
                            : 0.99 * goal * wanted / static_cast<double>(kept);
        left = static_cast<size_t>(goal / before * static_cast<double>(left));
    }
    return best;
}

}  // namespace lodestone::simplify
