// SPDX-License-Identifier: GPL-3.0-or-later
// Reduce: replaces a model's finest meshes by simpler ones, for `lodestone simplify`.
#pragma once

#include "base/job.h"
#include "model/model.h"

#include <cstdint>

namespace lodestone::hierarchy {

/// How triangles are saved; the C interface's lds_simplify_mode has the same numbers.
enum class ReductionMode : int32_t {
    Fast = 0,     // collapsing edges
    Best = 1,     // ... with more care
    Cluster = 2,  // joining what lies together
};

/// Exactly one of the first four is set.
struct ReductionOptions {
    double ratio = 0;        // of each object's triangles, 0...1
    uint64_t triangles = 0;  // in the whole model, shared in proportion
    double error = 0;        // metres in the model's frame: the fewest triangles within it
    double pixels = 0;       // the same in pixels, when the model's largest side covers `height_px`
    double height_px = 0;
    bool measure = false;  // measure the error of the result (always with `error` and `pixels`)
    uint64_t seed = 1;
    ReductionMode mode = ReductionMode::Fast;
    bool keep_topology = false;  // parts, holes and handles stay, at the price of the count
};

struct ReductionReport {
    uint64_t triangles_before = 0;
    uint64_t triangles = 0;
    double cpu_s = 0;       // of the simplification alone
    double error = -1;      // metres in the model's frame, the largest; negative: not measured
    double max_error = -1;  // likewise
};

/// Finest meshes must be resident; for `pixels` the root's bound must be known. Each object's error
/// counts as large as its largest occurrence makes it. Throws Error(InvalidArgument) when not
/// exactly one target is set.
ReductionReport reduce_model(Model& model, const ReductionOptions& wanted, const Job& job);

}  // namespace lodestone::hierarchy
