// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh parts: the connected parts of a mesh, and which of them are too small to keep.
#pragma once

#include "simplify/collapse/collapse_mesh.h"

namespace lodestone::simplify {

struct CollapsePart {
    uint32_t part = 0;
    size_t triangles = 0;  // the number at the start of the pass
    double cost = 0;       // the cost of removing it, comparable to that of a collapse
    bool located = false;  // the cost counts how far it lies from what is left without it
};

class CollapseParts {
public:
    /// Collects the parts; if there is only one, the list is empty (it is never removed). The cost
    /// of a part is `weight` times the second moment of its area about its centroid: the error of
    /// squeezing it to a point. Called before the first pass to a target, so that collapses do not
    /// make a part look smaller.
    void measure(const CollapseMesh& mesh, double weight);
    /// Counts the triangles that are left of the parts, before another pass.
    void count(const CollapseMesh& mesh);
    /// Makes the costs of the parts, from the removable one with number `from` on, count how far a
    /// part lies from what is left without it and without all cheaper ones: what lies on another
    /// part may go, what stands alone stays longer. Parts that are cheaper than `below`, and some
    /// dearer ones, are located, each once since they were measured. cost: n log n of the live
    /// triangles where one is. Throws Error(Cancelled).
    void locate(const CollapseMesh& mesh, double below, size_t from, const Job& job);

    /// The parts, cheapest first, without the dearest one (which always stays).
    const std::vector<CollapsePart>& removable() const { return parts_; }

    /// Removes the triangles of the given parts; returns how many were removed.
    size_t remove(CollapseMesh& mesh, const std::vector<uint8_t>& doomed) const;

private:
    std::vector<CollapsePart> parts_;
};

}  // namespace lodestone::simplify
