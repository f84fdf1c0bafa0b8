// SPDX-License-Identifier: GPL-3.0-or-later
#include "approximate/simplify.h"

#include "approximate/pass.h"

#include <algorithm>

namespace lodestone::approximate {
namespace {

void check_arguments(const Mesh& mesh, std::span<const size_t> targets,
                     const SimplifyOptions& options) {
    check(mesh);
    for (size_t i = 0; i < targets.size(); ++i) {
        if (targets[i] == 0 || (i > 0 && targets[i] >= targets[i - 1]))
            fail(Status::InvalidArgument, "target ", i, " is ", targets[i],
                 "; targets must be above 0 and fall");
    }
    const auto weight = [](const char* name, double value) {
        if (!(value >= 0 && value <= 1e6))
            fail(Status::InvalidArgument, name, " is ", value, ", not in 0...1e6");
    };
    weight("boundary_weight", options.boundary_weight);
    weight("seam_weight", options.seam_weight);
    weight("part_weight", options.part_weight);
    if (!(options.max_turn > 0 && options.max_turn < 90))
        fail(Status::InvalidArgument, "max_turn is ", options.max_turn,
             " degrees, not between 0 and 90");
}

/// Nothing in it has an extent: a few of its triangles draw what it draws.
Mesh first_triangles(const Mesh& mesh, size_t count) {
    std::vector<uint8_t> keep(mesh.triangles.size(), 0);
    std::fill(keep.begin(), keep.begin() + static_cast<std::ptrdiff_t>(count), uint8_t{1});
    return subset(mesh, keep);
}

}  // namespace

std::vector<Mesh> simplify_chain(const Mesh& mesh, std::span<const size_t> targets,
                                 const SimplifyOptions& options, const Job& job) {
    check_arguments(mesh, targets, options);
    std::vector<Mesh> results;
    size_t next = 0;
    for (; next < targets.size() && mesh.triangles.size() <= targets[next]; ++next)
        results.push_back(mesh);
    if (next == targets.size())
        return results;
    CollapseMesh working = open(mesh, job);
    if (working.live == 0) {
        for (; next < targets.size(); ++next)
            results.push_back(first_triangles(mesh, targets[next]));
        return results;
    }
    const size_t start = working.live;
    const size_t goal = targets.back();
    Reducer reducer(working, options);
    for (; next < targets.size(); ++next) {
        const bool reached = reducer.reduce(targets[next], job, [&] {
            if (start > goal)
                job.progress(static_cast<double>(start - working.live) /
                             static_cast<double>(start - goal));
        });
        // Where it gets stuck, the mesh so far is the last result, unless it already is.
        if (reached || results.empty() || working.live < results.back().triangles.size())
            results.push_back(extract(working));
        if (!reached)
            break;
    }
    job.progress(1);
    return results;
}

Mesh simplify(const Mesh& mesh, size_t triangles, const SimplifyOptions& options, const Job& job) {
    std::vector<Mesh> chain =
        simplify_chain(mesh, std::span<const size_t>(&triangles, 1), options, job);
    return std::move(chain.back());
}

}  // namespace lodestone::approximate
