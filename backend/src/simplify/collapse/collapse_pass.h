// SPDX-License-Identifier: GPL-3.0-or-later
// Collapse pass: batches of independent collapses, cheapest first, until a target is met.
#pragma once

#include "simplify/collapse/edge_collapse.h"
#include "simplify/collapse/mesh_parts.h"

#include <functional>
#include <utility>
#include <vector>

namespace lodestone::simplify {

/// The limits of one pass.
struct PassLimits {
    double share;       // it may take at most this share of the live triangles
    double slack;       // a careful pass stops at this many times the cost
    double quantile;    // that cost: of this many edges for each triangle wanted
    double most_slack;  // far from the target, the slack may be this many times larger
};

class CollapseReducer {
public:
    /// `mesh` must be compact.
    CollapseReducer(CollapseMesh& mesh, const SimplifyOptions& options);

    /// Collapses until at most `target` triangles live. False when nothing more can be done.
    /// `after_pass` is called after every pass. `adjacency` holds the lists of the mesh at first
    /// and, as the mesh is compact again, at the end.
    bool reduce(size_t target, const Job& job, const std::function<void()>& after_pass,
                Adjacency& adjacency);

    /// From now on holes and parts may vanish, as without SimplifyOptions::keep_topology.
    void free_topology() { options_.keep_topology = false; }

private:
    class CollapseBatch;
    /// Makes one batch of collapses; returns how many triangles it removed.
    size_t pass(size_t target, CollapseEffort effort, const Job& job);

    CollapseMesh& mesh_;
    SimplifyOptions options_;
    PassLimits pace_;
    Adjacency adjacency_;
    EdgeQueue edges_;
    CollapseParts parts_;
    bool begun_ = false;
    bool measured_ = false;  // the parts, as they were before the first pass to a target
    bool cut_ = false;       // a part may have become several parts
    bool asked_ = false;     // it is known whether loops of pinched edges may be cut
    bool loops_ = false;
    double reach_ = 1;           // the number of candidates is multiplied by this
    std::vector<uint8_t> used_;  // by vertex: it was an end in this pass
};

}  // namespace lodestone::simplify
