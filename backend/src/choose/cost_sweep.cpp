// SPDX-License-Identifier: GPL-3.0-or-later
#include "choose/cost_sweep.h"

#include <algorithm>
#include <functional>

namespace lodestone::choose {
namespace {

// How many children ahead memory is asked for.
// Taste: as kAhead in cut_chooser.cpp; more displace what is still needed, fewer come too late.
constexpr uint32_t kAheadOfSweep = 4;

}  // namespace

CostSweep::CostSweep(const ChoiceTable& table, const View& view, const Job& job)
    : table_(table),
      view_(view),
      finest_(view.pixel_error),
      field_(table.model(), view_, true),
      job_(job) {}

std::optional<double> CostSweep::least_that_fits(uint32_t root, const CutBudget& budget) {
    tally_.clear(table_);
    certain_tally_.clear(table_);
    PlacedNode top;
    top.node.object = table_.object(root).object;
    visit(root, top, table_.object(root).demand, 1, field_.root(), finest_);
    std::optional<double> found;
    for (;;) {
        while (!openings_.empty() && !too_many()) {
            const GroupOpening opening = openings_.back();
            openings_.pop_back();
            open(opening);
        }
        now_ = turns_.empty() ? finest_ : turns_.top().at;
        if (coarsest_ == kInfinity)
            coarsest_ = now_;
        if (!too_many() && budget.fits(sums_))
            found = now_;
        if (turns_.empty() || too_many() || !budget.fits(certain_))
            return found;
        while (!turns_.empty() && turns_.top().at == now_) {
            const uint32_t turning = turns_.top().visited;
            turns_.pop();
            leave(visited_[turning]);
            if (++visited_[turning].range < visited_[turning].end)
                enter(turning);
        }
    }
}

bool CostSweep::too_many() const {
    return nodes_ > kMostNodes || visited_.size() > 4 * kMostNodes;
}

/// Finds the levels that draw a node, from the threshold of now down to `low`.
void CostSweep::visit(uint32_t index, const PlacedNode& placed, double demand, double enlarge,
                      FactorField::FactorPath path, double low) {
    if ((visited_.size() & 1023u) == 0)
        job_.check();
    const TableRow& row = table_.row(index);
    OccurrenceSight sight;
    DetailFactors factors;
    if (!row.drawable || !find_sight(view_, field_, placed, row.group, table_.bound(index), demand,
                                     enlarge, path, sight, factors))
        return;
    // Between two neighbors of these thresholds decide_level() decides alike.
    thresholds_.assign(1, low);
    const size_t levels = by_error(view_) ? 0 : table_.object(index).all_levels;
    const auto add = [&](const TableLevel& level, double error) {
        const double threshold =
            error < kInfinity ? least_threshold(view_, sight, error, level.lod, levels) : kInfinity;
        if (threshold > low && threshold < now_)
            thresholds_.push_back(threshold);
    };
    for (uint32_t i = 0; i < row.level_count; ++i) {
        const TableLevel& level = table_.level(row.first_level + i);
        add(level, level.error);
        add(level, level.opens_from);
    }
    std::sort(thresholds_.begin(), thresholds_.end(), std::greater<>());
    RangedNode made;
    made.range = static_cast<uint32_t>(ranges_.size());
    bool opens = false;
    for (const double threshold : thresholds_) {
        view_.pixel_error = threshold;
        const LevelDecision decision = decide_level(table_, view_, index, placed.node, sight);
        if (!decision.drawn)
            return;
        const TableLevel* level = decision.opened ? nullptr : decision.level;
        opens = opens || decision.opened;
        if (ranges_.size() > made.range && ranges_.back().level == level)
            ranges_.back().low = threshold;
        else
            ranges_.push_back({threshold, level});
    }
    made.end = static_cast<uint32_t>(ranges_.size());
    made.lasts = low <= finest_ && (!row.group || row.lasting);
    if (opens) {
        made.group = static_cast<uint32_t>(groups_.size());
        groups_.push_back({placed, enlarge, path, index});
    }
    visited_.push_back(made);
    enter(static_cast<uint32_t>(visited_.size() - 1));
}

void CostSweep::open(const GroupOpening& opening) {
    const SweepGroup& group = groups_[opening.group];
    const TableObject& object = table_.object(group.row);
    for (uint32_t i = 0; i < std::min(object.child_count, kAheadOfSweep); ++i)
        table_.prefetch(object.first_child + i);
    for (uint32_t i = 0; i < object.child_count; ++i) {
        const TableChild& child = table_.child(object.first_child + i);
        PlacedNode placed;
        placed.node.placement = i;
        double enlarge = group.stretch;
        double demand = 1;
        if (!place_child(table_, group.placed.node, group.placed.world, child, placed, enlarge,
                         demand))
            continue;
        FactorField::FactorPath path = group.path;
        if (field_.follows_paths())
            path = field_.below(group.path, group.placed.world,
                                table_.model()
                                    .objects[group.placed.node.object]
                                    .representations[0]
                                    .assembly()
                                    .placements[i]);
        visit(child.row, placed, demand, enlarge, path, opening.low);
    }
}

void CostSweep::enter(uint32_t index) {
    const RangedNode& visited = visited_[index];
    const LevelRange& range = ranges_[visited.range];
    count(visited, range, true);
    if (range.level == nullptr)
        openings_.push_back({visited.group, range.low});
    if (range.low > finest_)
        turns_.push({range.low, index});
}

void CostSweep::leave(const RangedNode& visited) {
    count(visited, ranges_[visited.range], false);
}

void CostSweep::count(const RangedNode& visited, const LevelRange& range, bool more) {
    nodes_ += more ? 1 : -1;
    if (range.level == nullptr)
        return;
    tally_.count(*range.level, more, sums_);
    if (range.low <= finest_) {
        certain_tally_.count(*range.level, more, certain_);
    } else if (visited.lasts) {
        const uint64_t bytes = table_.model().costs.occurrence_bytes;
        certain_.bytes += more ? bytes : -bytes;
    }
}

}  // namespace lodestone::choose
