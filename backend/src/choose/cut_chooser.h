// SPDX-License-Identifier: GPL-3.0-or-later
// CutChooser: goes down from the root and decides at each occurrence how it is drawn. Inside of cut
// and step.
#pragma once

#include "choose/criterion.h"
#include "choose/cut.h"

#include <array>
#include <span>

namespace lodestone::choose {

/// More nodes than this are refused: as many occurrences take POV-Ray 25 GB, and groups that place
/// another twice, so many deep, would not end.
inline constexpr size_t kMostNodes = size_t{1} << 24u;

inline constexpr size_t kKinds = static_cast<size_t>(Kind::Assembly) + 1;

/// Throws Error(InvalidArgument) for a view that makes no sense.
void refuse_nonsense(const View& view);

/// A node and where it is, before they are kept apart.
struct PlacedNode {
    CutNode node;
    Affine world;
};

/// How a node is seen. False when a lens hides it. `path` becomes that of what is below it.
bool find_sight(const View& view, FactorField& field, const PlacedNode& placed, bool group,
                const Bound& local, double demand, double enlarge, FactorField::FactorPath& path,
                OccurrenceSight& sight, DetailFactors& factors);

/// What a group, opened, places (`around`: where it is): the node, where it is and by whom it is
/// seen, its stretch (from the group's) and its object's demand. False: nothing would show it.
bool place_child(const ChoiceTable& table, const CutNode& group, const Affine& around,
                 const TableChild& child, PlacedNode& placed, double& enlarge, double& demand);

/// Whether levels are judged by their errors.
inline bool by_error(const View& view) {
    return view.modifiers.criterion == DetailCriterion::Resolution ||
           view.modifiers.criterion == DetailCriterion::Feature;
}

/// By which level something is drawn.
struct LevelDecision {
    const TableLevel* level = nullptr;  // null: there is none that is allowed
    bool good = false;                  // good enough
    bool pinned = false;                // no other one is allowed
    bool cheaper = false;               // opened for that, though good enough
    bool opened = false;
    bool drawn = false;  // neither: it has nothing to be drawn by
};
LevelDecision decide_level(const ChoiceTable& table, const View& view, uint32_t row,
                           const CutNode& node, const OccurrenceSight& sight);

/// What stepping a cut keeps of a node, beside its transform.
struct SeenNode {
    uint32_t row = 0;
    uint32_t level = 0;  // of the table; LevelDecision's, any where that has none
    double stretch = 1;
    double total = 1;   // as OccurrenceSight's
    bool good = false;  // as LevelDecision's, and so is the next
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

/// What was visited, in the order of a cut; transforms and what is kept in the order of the nodes.
struct VisitedNodes {
    std::vector<CutNode> nodes;
    std::vector<Affine> transforms;
    std::vector<SeenNode> seen;

    void clear();
    void reserve(size_t count);
};

/// Visits what is drawn and the groups above it, depth first, each once.
class CutChooser {
public:
    /// `growing`: the same table, where rows are made on the way. All must outlive it.
    /// `most`: nodes; where there would be more, Error(InvalidArgument) is thrown, or it is too
    /// dear.
    CutChooser(const ChoiceTable& table, ChoiceTable* growing, const View& view, FactorField& field,
               const Job& job, size_t most = kMostNodes)
        : table_(table), growing_(growing), view_(view), field_(field), job_(job), most_(most) {}

    /// All of a cut, but its kinds and sums where `budget` was exceeded, or with one `most`: false.
    bool run(uint32_t root, const CutBudget& budget, Cut& cut);

    /// Appends the nodes alone, and what is kept of each.
    void run(uint32_t root, VisitedNodes& out);
    /// The same for what is below a group: itself, opened, and the nodes below. `path`: of what it
    /// places. Their parents are indices in `out`, its own is left as it is.
    void open(const PlacedNode& group, const SeenNode& known, const FactorField::FactorPath& path,
              VisitedNodes& out);

private:
    struct PendingChild {
        uint32_t parent;    // node
        uint32_t child;     // of the table
        uint32_t position;  // among the placements
        uint32_t depth;
    };
    /// The group at some depth that is being visited.
    struct GroupFrame {
        double stretch = 1;
        FactorField::FactorPath path;  // of what it places
    };

    /// What is known of an object before its row is looked at.
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
    Cut* cut_ = nullptr;                     // whose sums are made; null: none are
    std::vector<CutNode>* nodes_ = nullptr;  // what is appended to
    std::vector<Affine>* transforms_ = nullptr;
    std::vector<SeenNode>* seen_ = nullptr;  // null: nothing is kept
    FactorField::FactorPath path_;           // of what is visited; of motion only where that counts
    std::vector<PendingChild> stack_;
    std::vector<GroupFrame> frames_;  // by depth
    std::vector<bool> drawn_;         // by TableLevel::distinct
    std::array<uint64_t, kKinds> kinds_{};
    size_t visits_ = 0;
};

/// The words of kinds, and how many are drawn by each.
std::map<std::string, uint64_t> counts_by_kind(std::span<const uint64_t, kKinds> kinds);

}  // namespace lodestone::choose
