// SPDX-License-Identifier: GPL-3.0-or-later
// Step: a cut that goes along with the camera, and is the same as one made anew.
#pragma once

#include "quality/chooser.h"

namespace lodestone::quality {

/// Keeps of each node how far the eye may go before it could be drawn otherwise: what is decided by
/// distances changes no faster than the eye moves. A step looks again only at nodes that it may
/// change. source: temporal coherence of distances; Lipschitz bounds, exact by a margin for rounding
class Stepper {
public:
    explicit Stepper(std::shared_ptr<const Table> table) : table_(std::move(table)) {}
    Stepper(const Stepper&) = delete;
    Stepper& operator=(const Stepper&) = delete;

    const std::shared_ptr<const Table>& table() const { return table_; }

    /// Makes `cut`, which must be as the last call left it, what choose(table, view) gives. Sooner
    /// where only a perspective camera has moved or turned, by Resolution, with no other factors than
    /// importances and detail lenses; else it is chosen anew. When it throws, the cut is as before.
    /// cost: a step reads 24 bytes a node; it copies the nodes where groups opened or closed
    void step(const View& view, Cut& cut, const Job& job = {});

    /// Nodes that the last call looked at; all, when it chose anew.
    size_t looked_at() const { return looked_at_; }

private:
    /// Instead of the nodes [at, at + removed) of the cut now stand [begin, end) of the fresh ones.
    struct Edit {
        uint32_t at = 0;
        uint32_t removed = 1;
        uint32_t begin = 0;
        uint32_t end = 0;
    };
    /// Nodes [begin, end) that stay, and by how many places they move; what moves down wraps around.
    struct Run {
        uint32_t begin = 0;
        uint32_t end = 0;
        uint32_t shift = 0;
    };
    /// What a step reads of every node.
    struct Hot {
        std::vector<double> expires;  // travel from which on it may be drawn otherwise
        std::vector<double> sizes;    // error / size of a pixel at 1 m; -1: opened
        std::vector<double> places;   // distance + travel when it was looked at
        size_t size() const { return expires.size(); }
        void resize(size_t count);
    };

    bool steps(const View& view) const;
    void choose_anew(const View& view, Cut& cut, const Job& job);
    bool move(const View& view, Cut& cut, const Job& job);
    void look(Hot& hot, size_t index, const Node& node, const Seen& seen, const Sight& sight,
              const Decision& made) const;
    Sight sight_of(const Node& node, const Seen& seen) const;
    double margin(const Node& node, const Seen& seen, double z) const;
    void look_at_fresh(size_t begin);
    FactorField::Path path_below(const Cut& cut, uint32_t node);
    void find_expired();
    void find_edits(const Cut& cut, const Job& job);
    void count(const Node& node, const Seen& seen, bool more, Cut& cut);
    void commit(Cut& cut);
    void splice(Cut& cut);
    void insert(Cut& cut, const Edit& edit, uint32_t place, uint32_t parent);
    void find_largest(Cut& cut, uint32_t guess);

    std::shared_ptr<const Table> table_;
    bool known_ = false;  // everything below belongs to the cut
    View view_;           // that it is for
    double frame_ = 1;    // size of a pixel at 1 m, when it was chosen anew
    double pixel_ = 1;    // size of a pixel of view_ at 1 m
    double travel_ = 0;   // of the eye since then
    size_t looked_at_ = 0;
    std::unique_ptr<FactorField> field_;  // of view_, but for the camera
    std::vector<Seen> seen_;              // by node
    Hot hot_;
    std::vector<uint32_t> uses_;  // by TableLevel::distinct
    std::array<uint64_t, kKinds> kinds_{};

    // Of one step; kept for their memory.
    std::vector<uint32_t> expired_;
    std::vector<Edit> edits_;
    std::vector<Node> fresh_;
    std::vector<Seen> fresh_seen_;
    Hot fresh_hot_;
    std::vector<Run> runs_;
    std::vector<uint32_t> spare_chosen_;
};

}  // namespace lodestone::quality
