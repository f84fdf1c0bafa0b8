// SPDX-License-Identifier: GPL-3.0-or-later
// Node edits: replaces nodes of a cut by others.
#pragma once

#include "choose/follow/eye_slack.h"

namespace lodestone::choose {

/// The nodes [at, at + removed) of a cut are replaced by the nodes [begin, end) of the fresh ones.
struct NodeEdit {
    uint32_t at = 0;
    uint32_t removed = 1;
    uint32_t begin = 0;
    uint32_t end = 0;
};

/// The facts that are kept beside a cut. Facts as large as a transform stay in their place when
/// nodes move.
struct KeptNodes {
    std::vector<SeenNode> seen;      // by CutNode::transform
    std::vector<DrawnRange> ranges;  // by CutNode::transform
    std::vector<uint32_t> free;      // the transforms that belong to no node
    EyeSlack slack;                  // by node
};

/// Nodes that were visited, each with the facts that are kept of it.
struct FreshNodes : VisitedNodes {
    std::vector<DrawnRange> ranges;
    EyeSlack slack;
};

class NodeSplicer {
public:
    /// Reserves the memory that replace() needs for these edits, so that it cannot fail.
    void reserve(const std::vector<NodeEdit>& edits, const FreshNodes& fresh, Cut& cut,
                 KeptNodes& kept);
    /// Makes all edits, which rise; the sums of the cut are left as they are.
    void replace(const std::vector<NodeEdit>& edits, const FreshNodes& fresh, Cut& cut,
                 KeptNodes& kept);

private:
    /// Nodes [begin, end) that stay, and by how many places they move; a shift down wraps around.
    struct NodeRun {
        uint32_t begin = 0;
        uint32_t end = 0;
        uint32_t shift = 0;
    };
    void move_all(const std::vector<NodeEdit>& edits, const FreshNodes& fresh, Cut& cut,
                  KeptNodes& kept);
    void insert(const NodeEdit& edit, uint32_t place, uint32_t parent, const FreshNodes& fresh,
                Cut& cut, KeptNodes& kept);

    // Kept so that their memory is used again.
    std::vector<NodeRun> runs_;
    std::vector<uint32_t> spare_chosen_;
};

}  // namespace lodestone::choose
