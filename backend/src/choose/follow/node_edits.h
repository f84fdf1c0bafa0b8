// SPDX-License-Identifier: GPL-3.0-or-later
// Splice: nodes of a cut give way to others.
#pragma once

#include "choose/follow/eye_slack.h"

namespace lodestone::choose {

/// Instead of the nodes [at, at + removed) of a cut stand [begin, end) of the fresh ones.
struct NodeEdit {
    uint32_t at = 0;
    uint32_t removed = 1;
    uint32_t begin = 0;
    uint32_t end = 0;
};

/// What is kept of a cut besides it. What is as large as a transform stays where it is when nodes
/// move.
struct KeptNodes {
    std::vector<SeenNode> seen;      // by Node::transform
    std::vector<DrawnRange> ranges;  // by Node::transform
    std::vector<uint32_t> free;      // transforms of no node
    EyeSlack slack;                  // by node
};

/// Nodes that were visited, each beside what is kept of it.
struct FreshNodes : VisitedNodes {
    std::vector<DrawnRange> ranges;
    EyeSlack slack;
};

class NodeSplicer {
public:
    /// Makes room for what replace() does with these, so that it cannot fail.
    void reserve(const std::vector<NodeEdit>& edits, const FreshNodes& fresh, Cut& cut,
                 KeptNodes& kept);
    /// All edits, rising; the cut's sums are left as they are.
    void replace(const std::vector<NodeEdit>& edits, const FreshNodes& fresh, Cut& cut,
                 KeptNodes& kept);

private:
    /// Nodes [begin, end) that stay, and by how many places they move; what moves down wraps
    /// around.
    struct NodeRun {
        uint32_t begin = 0;
        uint32_t end = 0;
        uint32_t shift = 0;
    };
    void move_all(const std::vector<NodeEdit>& edits, const FreshNodes& fresh, Cut& cut,
                  KeptNodes& kept);
    void insert(const NodeEdit& edit, uint32_t place, uint32_t parent, const FreshNodes& fresh,
                Cut& cut, KeptNodes& kept);

    // Kept for their memory.
    std::vector<NodeRun> runs_;
    std::vector<uint32_t> spare_chosen_;
};

}  // namespace lodestone::choose
