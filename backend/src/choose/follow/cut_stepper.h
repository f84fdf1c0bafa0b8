// SPDX-License-Identifier: GPL-3.0-or-later
// Cut stepper: keeps a cut up to date while the camera moves; it equals a cut that is chosen anew.
#pragma once

#include "choose/cut_totals.h"
#include "choose/follow/node_edits.h"

#include <memory>
#include <optional>

namespace lodestone::choose {

/// Keeps two things for each node: the range of distances in which it is drawn as it is
/// (DrawnRange), and how far the eye may go before it could leave that range (EyeSlack). A step
/// decides again only the nodes that it may change, or that are within rounding of a change.
class CutStepper {
public:
    explicit CutStepper(std::shared_ptr<const ChoiceTable> table) : table_(std::move(table)) {}
    CutStepper(const CutStepper&) = delete;
    CutStepper& operator=(const CutStepper&) = delete;

    const std::shared_ptr<const ChoiceTable>& table() const { return table_; }

    /// Changes `cut`, which must be as the last call left it, into choose_cut(table, view). This is
    /// faster than choosing anew where only a perspective camera has moved or turned and detail
    /// lenses that hide nothing have changed, by Resolution, with no other factors than importances
    /// and such lenses. In all other cases, and where much changes, the cut is chosen anew. When it
    /// throws, the cut is as before. cost: a step reads 12 bytes for each node, and 64 for each
    /// node whose slack is used up; it moves the nodes behind groups that opened or closed
    void step(const View& view, Cut& cut, const Job& job = {});

    /// The number of nodes that the last call decided again; all nodes, when it chose anew.
    size_t decided_nodes() const { return looked_at_; }

private:
    bool steps(const View& view) const;
    void choose_anew(const View& view, Cut& cut, const Job& job);
    bool move(const View& view, Cut& cut, const Job& job);
    void keep_what_holds(const Cut& cut);
    bool change_lenses(const std::vector<DetailLens>& lenses, const Cut& cut);
    void look_at_fresh(size_t begin);
    FactorField::FactorPath path_below(const Cut& cut, uint32_t node);
    void find_edits(const Cut& cut, const Job& job);
    void count(const CutNode& node, const SeenNode& seen, bool more, Cut& cut);
    void commit(Cut& cut);

    std::shared_ptr<const ChoiceTable> table_;
    bool known_ = false;  // all members below belong to the cut
    std::optional<EyeWalk> walk_;
    size_t looked_at_ = 0;
    uint32_t in_vain_ = 0;  // grows with each step in a row whose kept facts were useless
    uint32_t plain_ = 0;    // so often the cut is chosen without keeping facts
    std::unique_ptr<FactorField> field_;  // for the view of the walk, whatever its camera
    KeptNodes kept_;
    CutTotals tally_;

    // The data of one step; kept so that their memory is used again.
    std::vector<uint32_t> expired_;
    std::vector<uint32_t> reached_;  // the nodes that changed lenses reach
    std::vector<NodeEdit> edits_;
    FreshNodes fresh_;
    NodeSplicer splicer_;
};

}  // namespace lodestone::choose
