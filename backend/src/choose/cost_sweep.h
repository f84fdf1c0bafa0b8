// SPDX-License-Identifier: GPL-3.0-or-later
// Cost sweep: the costs of the cuts of a view at all thresholds, from the coarsest down. Only the
// choice within a budget uses it.
#pragma once

#include "choose/cut_totals.h"

#include <deque>
#include <optional>
#include <queue>

namespace lodestone::choose {

/// A node of a cut is drawn by one level from one threshold to another, or it is opened. While the
/// threshold sinks, each of these comes once and goes once, and the sums follow. So all cuts
/// together cost as much as the finest one that is reached.
class CostSweep {
public:
    /// The view has the finest threshold that is wanted. All arguments must outlive the sweep.
    CostSweep(const ChoiceTable& table, const View& view, const Job& job);

    /// The least threshold whose cut fits, to the last bit; none if no finite threshold fits. The
    /// sweep goes on to finer cuts until the levels that every finer cut draws, too, cost more than
    /// the budget. May be called once. Throws Error(Cancelled).
    std::optional<double> least_that_fits(uint32_t root, const CutBudget& budget);
    /// The least threshold that gives the coarsest cut; known after least_that_fits().
    double coarsest() const { return coarsest_; }

private:
    /// The level that draws a node down to a threshold (from the threshold of the range before it).
    struct LevelRange {
        double low = 0;
        const TableLevel* level = nullptr;  // null: opened
    };
    struct RangedNode {
        uint32_t range = 0;  // the range that the threshold is in
        uint32_t end = 0;
        uint32_t group = 0;  // in groups_, if the node may be opened
        /// Down to the finest threshold, the node or something below it is drawn.
        bool lasts = false;
    };
    struct SweepGroup {
        PlacedNode placed;
        double stretch = 1;
        FactorField::FactorPath path;  // that of the objects it places
        uint32_t row = 0;
    };
    struct GroupOpening {
        uint32_t group = 0;
        double low = 0;  // the group is open down to this threshold
    };
    struct SweepEvent {
        double at = 0;
        uint32_t visited = 0;
        bool operator<(const SweepEvent& other) const { return at < other.at; }
    };

    void visit(uint32_t row, const PlacedNode& placed, double demand, double enlarge,
               FactorField::FactorPath path, double low);
    void open(const GroupOpening& opening);
    void enter(uint32_t visited);
    void leave(const RangedNode& visited);
    void count(const RangedNode& visited, const LevelRange& range, bool more);
    bool too_many() const;

    const ChoiceTable& table_;
    View view_;  // its threshold changes
    const double finest_;
    FactorField field_;
    const Job& job_;

    double now_ = kInfinity;  // the threshold, which comes down from infinity
    double coarsest_ = kInfinity;
    std::vector<LevelRange> ranges_;
    std::vector<RangedNode> visited_;
    std::deque<SweepGroup> groups_;
    std::vector<GroupOpening> openings_;  // still to be made
    std::priority_queue<SweepEvent> turns_;
    std::vector<double> thresholds_;  // the thresholds of one node

    Cut sums_;  // at the threshold now_
    CutTotals tally_;
    Cut certain_;  // the sums of the levels that all finer cuts draw
    CutTotals certain_tally_;
    size_t nodes_ = 0;
};

}  // namespace lodestone::choose
