// SPDX-License-Identifier: GPL-3.0-or-later
// Step: a cut that goes along with the camera, and is the same as one made anew.
#pragma once

#include "choose/cut_totals.h"
#include "choose/follow/node_edits.h"

#include <memory>
#include <optional>

namespace lodestone::choose {

/// Keeps of each node from where to where it is drawn as it is (Range), and how far the eye may go
/// before it could leave that (EyeSlack). A step decides again only what it changes, or what is within
/// rounding of it.
class CutStepper {
public:
    explicit CutStepper(std::shared_ptr<const ChoiceTable> table) : table_(std::move(table)) {}
    CutStepper(const CutStepper&) = delete;
    CutStepper& operator=(const CutStepper&) = delete;

    const std::shared_ptr<const ChoiceTable>& table() const { return table_; }

    /// Makes `cut`, which must be as the last call left it, what choose_cut(table, view) gives. Sooner
    /// where only a perspective camera has moved or turned, and detail lenses that hide nothing
    /// have changed, by Resolution, with no other factors than importances and such lenses; else it
    /// is chosen anew, as where much changes. When it throws, the cut is as before. cost: a step
    /// reads 12 bytes a node, and 64 of those whose slack is eaten; it moves the nodes behind
    /// groups that opened or closed
    void step(const View& view, Cut& cut, const Job& job = {});

    /// Nodes that the last call decided again; all, when it chose anew.
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
    bool known_ = false;  // everything below belongs to the cut
    std::optional<EyeWalk> walk_;
    size_t looked_at_ = 0;
    uint32_t in_vain_ = 0;  // grows with steps for which all was kept in vain, one after the other
    uint32_t plain_ = 0;    // how often to choose without keeping anything
    std::unique_ptr<FactorField> field_;  // of the walk's view, but for the camera
    KeptNodes kept_;
    CutTotals tally_;

    // Of one step; kept for their memory.
    std::vector<uint32_t> expired_;
    std::vector<uint32_t> reached_;  // by lenses that have changed
    std::vector<NodeEdit> edits_;
    FreshNodes fresh_;
    NodeSplicer splicer_;
};

}  // namespace lodestone::choose
