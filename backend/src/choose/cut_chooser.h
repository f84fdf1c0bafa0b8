// SPDX-License-Identifier: GPL-3.0-or-later
// Cut chooser: goes down from the root and decides at each occurrence how it is drawn. Only cut and
// follow use it.
#pragma once

#include "choose/criterion.h"
#include "choose/cut.h"

#include <array>
#include <span>

namespace lodestone::choose {

/// The most nodes of a cut; more are refused. Taste: as many occurrences take POV-Ray 25 GB, and a
/// chain of groups that each place the next one twice would not end.
inline constexpr size_t kMostNodes = size_t{1} << 24u;

/// One more than the largest number of a kind.
inline constexpr size_t kKinds = kKindLimit;

/// Throws Error(InvalidArgument) for a view that makes no sense.
void refuse_nonsense(const View& view);

/// A node and its transform, before they are stored apart.
struct PlacedNode {
    CutNode node;
    Affine world;
};

/// Finds how a node is seen. False when a lens hides it. `path` becomes the path of its children.
bool find_sight(const View& view, FactorField& field, const PlacedNode& placed, bool group,
                const Bound& local, double demand, double enlarge, FactorField::FactorPath& path,
                OccurrenceSight& sight, DetailFactors& factors);

/// Finds a child that an opened group places (`around`: the group's transform): its node, transform
/// and ray classes, its stretch (from the group's) and the demand of its object. False: no ray
/// would see it.
bool place_child(const ChoiceTable& table, const CutNode& group, const Affine& around,
                 const TableChild& child, PlacedNode& placed, double& enlarge, double& demand);

/// Whether the view judges levels by their errors.
inline bool by_error(const View& view) {
    return view.modifiers.criterion == DetailCriterion::Resolution ||
           view.modifiers.criterion == DetailCriterion::Feature;
}

/// The level by which something is drawn.
struct LevelDecision {
    const TableLevel* level = nullptr;  // null: no level is allowed
    bool good = false;                  // the level is good enough
    bool pinned = false;                // no other level is allowed
    bool cheaper = false;  // opened because that is cheaper, though the level is good enough
    bool opened = false;
    bool drawn = false;  // false and not opened: nothing can draw it
};
LevelDecision decide_level(const ChoiceTable& table, const View& view, uint32_t row,
                           const CutNode& node, const OccurrenceSight& sight);

/// The facts about a node that following a cut keeps, beside its transform.
struct SeenNode {
    uint32_t row = 0;
    /// The index in the table of the level of LevelDecision; any number where that has none.
    uint32_t level = 0;
    double stretch = 1;
    double total = 1;   // the same as in OccurrenceSight
    bool good = false;  // the same as in LevelDecision, like `cheaper`
    bool cheaper = false;

    SeenNode() = default;
    SeenNode(const ChoiceTable& table, uint32_t of, const OccurrenceSight& sight,
             const LevelDecision& made)
        : row(of),
          level(made.level != nullptr ? static_cast<uint32_t>(made.level - &table.level(0)) : 0),
          stretch(sight.stretch),
          total(sight.total),
          good(made.good),
          cheaper(made.cheaper) {}
};

/// The visited nodes in the order of a cut; transforms and kept facts are in the order of the
/// nodes.
struct VisitedNodes {
    std::vector<CutNode> nodes;
    std::vector<Affine> transforms;
    std::vector<SeenNode> seen;

    void clear();
    void reserve(size_t count);
};

/// Visits the occurrences that are drawn and the groups above them, depth first, each once.
class CutChooser {
public:
    /// `growing`: the same table, if rows are made on the way. All arguments must outlive the
    /// chooser. `most`: the most nodes; if there are more, Error(InvalidArgument) is thrown, or
    /// with a budget the cut does not fit.
    CutChooser(const ChoiceTable& table, ChoiceTable* growing, const View& view, FactorField& field,
               const Job& job, size_t most = kMostNodes)
        : table_(table), growing_(growing), view_(view), field_(field), job_(job), most_(most) {}

    /// Makes the whole cut. False: it exceeds `budget` or `most`, and its kinds and sums are not
    /// complete.
    bool run(uint32_t root, const CutBudget& budget, Cut& cut);

    /// Appends the nodes alone, with the facts that are kept of each.
    void run(uint32_t root, VisitedNodes& out);
    /// Appends a group, opened, and the nodes below it. `path`: the path of the objects it places.
    /// The parents of the nodes below are indices in `out`; the parent of the group is left as it
    /// is.
    void open(const PlacedNode& group, const SeenNode& known, const FactorField::FactorPath& path,
              VisitedNodes& out);

private:
    struct PendingChild {
        uint32_t parent;    // node
        uint32_t child;     // in the table
        uint32_t position;  // among the placements
        uint32_t depth;
    };
    /// The group at some depth that is being visited.
    struct GroupFrame {
        double stretch = 1;
        FactorField::FactorPath path;  // that of the objects it places
    };

    /// The facts about an object that are known before its row is read.
    struct KnownObject {
        uint32_t row = 0;
        double demand = 1;
        double finest_error = 0;
        uint32_t first_child = 0;
        uint32_t child_count = 0;
        uint32_t first_row = 0;
        uint32_t first_level = 0;
    };

    void visit_root(uint32_t root);
    void visit_child(const PendingChild& entry);
    void visit(const KnownObject& known, PlacedNode& placed, double enlarge,
               FactorField::FactorPath& path, uint32_t depth);
    uint32_t append(PlacedNode& placed, const SeenNode& seen);
    void push_children(const KnownObject& known, uint32_t index, double enlarge,
                       const FactorField::FactorPath& path, uint32_t depth);
    KnownObject known(uint32_t row) const;
    void take(uint32_t index, const TableLevel& level, double shown_px);
    bool exceeds_budget() const;
    void visit_all();

    const ChoiceTable& table_;
    ChoiceTable* growing_;
    const View& view_;
    FactorField& field_;
    const Job& job_;
    const size_t most_;
    const CutBudget* budget_ = nullptr;
    Cut* cut_ = nullptr;                     // its sums are computed; null: none are
    std::vector<CutNode>* nodes_ = nullptr;  // the nodes are appended here
    std::vector<Affine>* transforms_ = nullptr;
    std::vector<SeenNode>* seen_ = nullptr;  // null: no facts are kept
    /// The path of the visited node; with motion only where motion counts.
    FactorField::FactorPath path_;
    std::vector<PendingChild> stack_;
    std::vector<GroupFrame> frames_;  // by depth
    std::vector<bool> drawn_;         // by TableLevel::distinct
    std::array<uint64_t, kKinds> kinds_{};
    size_t visits_ = 0;
};

/// The words of the kinds, with the number of occurrences drawn by each.
std::map<std::string, uint64_t> counts_by_kind(std::span<const uint64_t, kKinds> kinds);

}  // namespace lodestone::choose
