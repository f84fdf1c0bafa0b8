// SPDX-License-Identifier: GPL-3.0-or-later
// Reduce: replaces a model's finest meshes by simpler ones, for `lodestone simplify`.
#pragma once

#include "base/job.h"
#include "model/model.h"

namespace lodestone::build {

/// Exactly one of the first three is set.
struct Reduction {
    double ratio = 0;        // of each object's triangles, 0...1
    uint64_t triangles = 0;  // in the whole model, shared in proportion
    double error = 0;        // metres: the fewest triangles within it
    bool measure = false;    // measure the error of the result (always with `error`)
    uint64_t seed = 1;
};

struct ReductionReport {
    uint64_t triangles_before = 0;
    uint64_t triangles = 0;
    double cpu_s = 0;       // of the collapse alone
    double error = -1;      // metres, the largest of all objects; negative when not measured
    double max_error = -1;  // likewise
};

/// Finest meshes must be resident. Throws Error(InvalidArgument) when not exactly one target is set.
ReductionReport reduce(Model& model, const Reduction& wanted, const Job& job);

}  // namespace lodestone::build
