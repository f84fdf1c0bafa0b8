// SPDX-License-Identifier: GPL-3.0-or-later
// Splice: nodes of a cut give way to others.
#pragma once

#include "choose/follow/eye_slack.h"

namespace lodestone::choose {

/// Instead of the nodes [at, at + removed) of a cut stand [begin, end) of the fresh ones.
struct Edit {
    uint32_t at = 0;
    uint32_t removed = 1;
    uint32_t begin = 0;
    uint32_t end = 0;
};

/// What is kept of a cut besides it. What is as large as a transform stays where it is when nodes
/// move.
struct Kept {
    std::vector<Seen> seen;      // by Node::transform
    std::vector<Range> ranges;   // by Node::transform
    std::vector<uint32_t> free;  // transforms of no node
    Slack slack;                 // by node
};

/// Nodes that were visited, each beside what is kept of it.
struct Fresh : Visited {
    std::vector<Range> ranges;
    Slack slack;
};

class Splicer {
public:
    /// Makes room for what replace() does with these, so that it cannot fail.
    void reserve(const std::vector<Edit>& edits, const Fresh& fresh, Cut& cut, Kept& kept);
    /// All edits, rising; the cut's sums are left as they are.
    void replace(const std::vector<Edit>& edits, const Fresh& fresh, Cut& cut, Kept& kept);

private:
    /// Nodes [begin, end) that stay, and by how many places they move; what moves down wraps
    /// around.
    struct Run {
        uint32_t begin = 0;
        uint32_t end = 0;
        uint32_t shift = 0;
    };
    void move_all(const std::vector<Edit>& edits, const Fresh& fresh, Cut& cut, Kept& kept);
    void insert(const Edit& edit, uint32_t place, uint32_t parent, const Fresh& fresh, Cut& cut,
                Kept& kept);

    // Kept for their memory.
    std::vector<Run> runs_;
    std::vector<uint32_t> spare_chosen_;
};

}  // namespace lodestone::choose
