// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/fit/level_fitter.h"

#include "simplify/collapse/collapse_pass.h"
#include "simplify/fit/surface_fit.h"

#include <algorithm>

namespace lodestone::simplify {
namespace {

// The longer fit; see FitOptions.
// Fitted: by tests/bench/peers/bench_simplify.py, 36 pairs and 16 turned models.
constexpr FitOptions kLongFit{20, 1, 2, 8, 5, true, 0.02f, 0.6f};
/// The share of the triangles that are collapsed and put back where the mesh is farthest off, which
/// is in a few spots.
/// Fitted: by tests/bench/peers/bench_simplify.py, Hausdorff distance, CPU of nine shared models.
constexpr double kPutBack = 0.0025;

}  // namespace

CollapseMesh LevelFitter::fit(const CollapseMesh& level, const Adjacency& adjacency,
                              Adjacency& around, const Job& job) const {
    CollapseMesh before = level;
    CollapseMesh after = level;
    around = adjacency;
    FitOptions options = kLongFit;
    const auto spare = static_cast<size_t>(kPutBack / 2 * static_cast<double>(level.live));
    if (puts_back_ && spare > 0) {
        CollapseReducer(after, options_)
            .reduce(
                level.live - 2 * spare, job, [] {}, around);
        options.insert = std::min(spare, (level.live - after.live) / 2);
    }
    fit_surface(after, source_, around, options, job);
    if (!keep_better(before, after, source_, meter_, job)) {
        around = adjacency;
        return before;
    }
    if (options.insert > 0)
        around.build(after);
    return after;
}

}  // namespace lodestone::simplify
