// SPDX-License-Identifier: GPL-3.0-or-later
// Passes: batches of independent collapses, cheapest first, until a target is met.
#pragma once

#include "simplify/collapse/edge_collapse.h"
#include "simplify/collapse/mesh_parts.h"

#include <functional>
#include <utility>
#include <vector>

namespace lodestone::simplify {

/// How far one pass goes.
struct PassLimits {
    double share;       // of the live triangles it may take
    double slack;       // a careful pass stops at this many times the cost
    double quantile;    // that this many edges for each triangle wanted do not exceed
    double most_slack;  // times that, far from the target
};

class CollapseReducer {
public:
    /// `mesh` must be compact.
    CollapseReducer(CollapseMesh& mesh, const SimplifyOptions& options);

    /// Collapses until at most `target` triangles live. False when nothing more can be done.
    /// `after_pass` is called after every pass. `adjacency` holds the mesh's lists, at first and,
    /// as the mesh is compact again, at the end.
    bool reduce(size_t target, const Job& job, const std::function<void()>& after_pass,
                Adjacency& adjacency);

private:
    class CollapseBatch;
    /// One batch; returns how many triangles went.
    size_t pass(size_t target, CollapseEffort effort, const Job& job);

    CollapseMesh& mesh_;
    SimplifyOptions options_;
    PassLimits pace_;
    Adjacency adjacency_;
    EdgeQueue edges_;
    CollapseParts parts_;
    bool begun_ = false;
    bool measured_ = false;  // parts, as they were before the first pass to a target
    bool cut_ = false;       // parts may have become several
    bool asked_ = false;     // whether loops of pinched edges may be cut
    bool loops_ = false;
    double reach_ = 1;           // so many times more candidates
    std::vector<uint8_t> used_;  // as an end in this pass, by vertex
};

}  // namespace lodestone::simplify
