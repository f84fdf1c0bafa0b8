// SPDX-License-Identifier: GPL-3.0-or-later
// Parts: connected pieces of a mesh, and which of them are too small to keep.
#pragma once

#include "simplify/collapse/collapse_mesh.h"

namespace lodestone::simplify {

struct CollapsePart {
    uint32_t part = 0;
    size_t triangles = 0;  // at the start of the pass
    double cost = 0;       // of removing it, comparable to the cost of a collapse
};

class CollapseParts {
public:
    /// Collects the parts; with one the list is empty (it is never removed).
    /// The cost is `weight` x the second moment of its area about its centroid: what squeezing it
    /// to a point does. Asked before the first pass to a target: collapses must not make a part
    /// look smaller.
    void measure(const CollapseMesh& mesh, double weight);
    /// What is left of them before another pass.
    void count(const CollapseMesh& mesh);

    /// Cheapest first, without the dearest (which stays whatever happens).
    const std::vector<CollapsePart>& removable() const { return parts_; }

    /// Removes the given parts' triangles; returns how many went.
    size_t remove(CollapseMesh& mesh, const std::vector<uint8_t>& doomed) const;

private:
    std::vector<CollapsePart> parts_;
};

}  // namespace lodestone::simplify
