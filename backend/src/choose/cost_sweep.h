// SPDX-License-Identifier: GPL-3.0-or-later
// Cost sweep: what the cuts of a view cost at all thresholds, from the coarsest on down. Inside of
// budget.
#pragma once

#include "choose/cut_totals.h"

#include <deque>
#include <optional>
#include <queue>

namespace lodestone::choose {

/// A node of a cut is drawn by one level from a threshold to another, or opened. With the threshold
/// sinking, each of these comes and goes once, and the sums follow: all cuts cost as much as the
/// finest that is reached.
class CostSweep {
public:
    /// From the finest threshold that is wanted on, which the view has. All must outlive it.
    CostSweep(const ChoiceTable& table, const View& view, const Job& job);

    /// The least threshold whose cut fits, to the last bit; none: there is no finite one. What is
    /// finer is looked at until as much costs more than the budget as any finer cut draws, too.
    /// Once. Throws Error(Cancelled).
    std::optional<double> least_that_fits(uint32_t root, const CutBudget& budget);
    /// Then: the least threshold that gives the coarsest cut.
    double coarsest() const { return coarsest_; }

private:
    /// What a node is drawn by down to a threshold (from the one of the range before it).
    struct LevelRange {
        double low = 0;
        const TableLevel* level = nullptr;  // null: opened
    };
    struct RangedNode {
        uint32_t range = 0;  // the one that it is in
        uint32_t end = 0;
        uint32_t group = 0;  // in groups_; of one that may be opened
        bool lasts = false;  // down to the finest it or something below it is drawn
    };
    struct SweepGroup {
        PlacedNode placed;
        double stretch = 1;
        FactorField::FactorPath path;  // of what it places
        uint32_t row = 0;
    };
    struct GroupOpening {
        uint32_t group = 0;
        double low = 0;  // down to where it is open
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

    double now_ = kInfinity;  // the threshold, from above
    double coarsest_ = kInfinity;
    std::vector<LevelRange> ranges_;
    std::vector<RangedNode> visited_;
    std::deque<SweepGroup> groups_;
    std::vector<GroupOpening> openings_;  // to be made
    std::priority_queue<SweepEvent> turns_;
    std::vector<double> thresholds_;  // of one node

    Cut sums_;  // of now
    CutTotals tally_;
    Cut certain_;  // of what every finer cut draws, too
    CutTotals certain_tally_;
    size_t nodes_ = 0;
};

}  // namespace lodestone::choose
