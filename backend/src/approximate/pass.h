// SPDX-License-Identifier: GPL-3.0-or-later
// Passes: batches of independent collapses, cheapest first, until a target is met.
#pragma once

#include "approximate/collapse.h"
#include "approximate/parts.h"

#include <functional>

namespace lodestone::approximate {

class Reducer {
public:
    Reducer(CollapseMesh& mesh, const SimplifyOptions& options) : mesh_(mesh), options_(options) {}

    /// Collapses until at most `target` triangles live. False when nothing more can be done.
    /// `after_pass` is called after every pass.
    bool reduce(size_t target, const Job& job, const std::function<void()>& after_pass);

private:
    /// One batch; returns how many triangles went.
    size_t pass(size_t target, Effort effort, const Job& job);
    /// Fills order_ with the edges worth trying, cheapest first, and costs_ (by edge).
    void rank(Effort effort, const Job& job);

    CollapseMesh& mesh_;
    SimplifyOptions options_;
    Adjacency adjacency_;
    Edges edges_;
    Parts parts_;
    std::vector<uint32_t> keys_, order_, keys_spare_, order_spare_;
    std::vector<uint8_t> used_;
    std::vector<glm::dvec3> other_points_;
};

}  // namespace lodestone::approximate
