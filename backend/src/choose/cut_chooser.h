// SPDX-License-Identifier: GPL-3.0-or-later
// Chooser: goes down from the root and decides at each occurrence how it is drawn. Inside of cut
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
struct Placed {
    Node node;
    Affine world;
};

/// How a node is seen. False when a lens hides it. `path` becomes that of what is below it.
bool see(const View& view, FactorField& field, const Placed& placed, bool group, const Bound& local,
         double demand, double enlarge, FactorField::Path& path, Sight& sight, Factors& factors);

/// What a group, opened, places (`around`: where it is): the node, where it is and by whom it is
/// seen, its stretch (from the group's) and its object's demand. False: nothing would show it.
bool place(const Table& table, const Node& group, const Affine& around, const TableChild& child,
           Placed& placed, double& enlarge, double& demand);

/// Whether levels are judged by their errors.
inline bool by_error(const View& view) {
    return view.modifiers.criterion == Criterion::Resolution ||
           view.modifiers.criterion == Criterion::Feature;
}

/// By which level something is drawn.
struct Decision {
    const TableLevel* level = nullptr;  // null: there is none that is allowed
    bool good = false;                  // good enough
    bool pinned = false;                // no other one is allowed
    bool cheaper = false;               // opened for that, though good enough
    bool opened = false;
    bool drawn = false;  // neither: it has nothing to be drawn by
};
Decision decide(const Table& table, const View& view, uint32_t row, const Node& node,
                const Sight& sight);

/// What stepping a cut keeps of a node, beside its transform.
struct Seen {
    uint32_t row = 0;
    uint32_t level = 0;  // of the table; Decision's, any where that has none
    double stretch = 1;
    double total = 1;   // as Sight's
    bool good = false;  // as Decision's, and so is the next
    bool cheaper = false;

    Seen() = default;
    Seen(const Table& table, uint32_t of, const Sight& sight, const Decision& made)
        : row(of),
          level(made.level != nullptr ? static_cast<uint32_t>(made.level - &table.level(0)) : 0),
          stretch(sight.stretch),
          total(sight.total),
          good(made.good),
          cheaper(made.cheaper) {}
};

/// What was visited, in the order of a cut; transforms and what is kept in the order of the nodes.
struct Visited {
    std::vector<Node> nodes;
    std::vector<Affine> transforms;
    std::vector<Seen> seen;

    void clear();
    void reserve(size_t count);
};

/// Visits what is drawn and the groups above it, depth first, each once.
class Chooser {
public:
    /// `growing`: the same table, where rows are made on the way. All must outlive it.
    /// `most`: nodes; where there would be more, Error(InvalidArgument) is thrown, or it is too
    /// dear.
    Chooser(const Table& table, Table* growing, const View& view, FactorField& field,
            const Job& job, size_t most = kMostNodes)
        : table_(table), growing_(growing), view_(view), field_(field), job_(job), most_(most) {}

    /// All of a cut, but its kinds and sums where `budget` was exceeded, or with one `most`: false.
    bool run(uint32_t root, const Budget& budget, Cut& cut);

    /// Appends the nodes alone, and what is kept of each.
    void run(uint32_t root, Visited& out);
    /// The same for what is below a group: itself, opened, and the nodes below. `path`: of what it
    /// places. Their parents are indices in `out`, its own is left as it is.
    void open(const Placed& group, const Seen& known, const FactorField::Path& path, Visited& out);

private:
    struct Entry {
        uint32_t parent;    // node
        uint32_t child;     // of the table
        uint32_t position;  // among the placements
        uint32_t depth;
    };
    /// The group at some depth that is being visited.
    struct Frame {
        double stretch = 1;
        FactorField::Path path;  // of what it places
    };

    /// What is known of an object before its row is looked at.
    struct Known {
        uint32_t row = 0;
        double demand = 1;
        double finest_error = 0;
        uint32_t first_child = 0;
        uint32_t child_count = 0;
        uint32_t first_row = 0;
        uint32_t first_level = 0;
    };

    void visit_root(uint32_t root);
    void visit_child(const Entry& entry);
    void visit(const Known& known, Placed& placed, double enlarge, FactorField::Path& path,
               uint32_t depth);
    uint32_t append(Placed& placed, const Seen& seen);
    void push_children(const Known& known, uint32_t index, double enlarge,
                       const FactorField::Path& path, uint32_t depth);
    Known known(uint32_t row) const;
    void take(uint32_t index, const TableLevel& level, double shown_px);
    bool too_dear() const;
    void visit_all();

    const Table& table_;
    Table* growing_;
    const View& view_;
    FactorField& field_;
    const Job& job_;
    const size_t most_;
    const Budget* budget_ = nullptr;
    Cut* cut_ = nullptr;                  // whose sums are made; null: none are
    std::vector<Node>* nodes_ = nullptr;  // what is appended to
    std::vector<Affine>* transforms_ = nullptr;
    std::vector<Seen>* seen_ = nullptr;  // null: nothing is kept
    FactorField::Path path_;             // of what is visited; of motion only where that counts
    std::vector<Entry> stack_;
    std::vector<Frame> frames_;  // by depth
    std::vector<bool> drawn_;    // by TableLevel::distinct
    std::array<uint64_t, kKinds> kinds_{};
    size_t visits_ = 0;
};

/// The words of kinds, and how many are drawn by each.
std::map<std::string, uint64_t> named(std::span<const uint64_t, kKinds> kinds);

}  // namespace lodestone::choose
