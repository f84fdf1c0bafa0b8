// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/simplify.h"

#include "simplify/collapse/collapse_pass.h"
#include "simplify/fit/level_attributes.h"
#include "simplify/fit/level_fitter.h"
#include "simplify/fit/surface_fit.h"

#include <algorithm>

namespace lodestone::simplify {
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
    if (options.mode != SimplifyMode::Fast && options.mode != SimplifyMode::Best)
        fail(Status::InvalidArgument, "mode is ", static_cast<int>(options.mode), ", not 0 or 1");
    weight("boundary_weight", options.boundary_weight);
    weight("seam_weight", options.seam_weight);
    weight("part_weight", options.part_weight);
    if (!(options.max_turn > 0 && options.max_turn < 90))
        fail(Status::InvalidArgument, "max_turn is ", options.max_turn,
             " degrees, not between 0 and 90");
}

/// A few triangles of a mesh without any extent, which draw the same as all.
Mesh first_triangles(const Mesh& mesh, size_t count) {
    std::vector<uint8_t> keep(mesh.triangles.size(), 0);
    std::fill(keep.begin(), keep.begin() + static_cast<std::ptrdiff_t>(count), uint8_t{1});
    return subset(mesh, keep);
}

/// A level with the vertices that ended up in each place, from the collapses so far.
TracedLevel traced(CollapseMesh& mesh, std::span<const glm::vec3> normals) {
    TracedLevel level;
    level.mesh = extract(mesh, &level.places, normals);
    std::vector<uint32_t> place_of(mesh.merged.size(), kNone);  // by first number
    for (uint32_t v = 0; v < mesh.ids.size(); ++v)
        place_of[mesh.ids[v]] = v;
    std::vector<uint32_t>& merged = mesh.merged;
    for (uint32_t id = 0; id < merged.size(); ++id) {
        uint32_t root = id;
        while (merged[root] != root) {
            merged[root] = merged[merged[root]];
            root = merged[root];
        }
        merged[id] = root;
        if (place_of[root] != kNone)
            level.origins.emplace_back(place_of[root], mesh.sources[id]);
    }
    // Vertices at one position came from the same one.
    std::sort(level.origins.begin(), level.origins.end());
    level.origins.erase(std::unique(level.origins.begin(), level.origins.end()),
                        level.origins.end());
    return level;
}

/// A level in which every vertex is where it was.
TracedLevel untouched(const Mesh& mesh) {
    TracedLevel level{mesh, weld(mesh), {}};
    for (uint32_t v = 0; v < level.places.size(); ++v) {
        if (level.places[v] == v)
            level.origins.emplace_back(v, v);
    }
    return level;
}

/// The chain of any kind of result. `whole` makes a result of an input that is within a target
/// already (or of the first triangles of one without extent, which are not tracked), `taken` one of
/// the mesh so far.
template <typename Result, typename Whole, typename Taken>
std::vector<Result> chain(const Mesh& mesh, OtherPositions others, bool tracked,
                          std::span<const size_t> targets, const SimplifyOptions& options,
                          const Job& job, const Whole& whole, const Taken& taken) {
    check_arguments(mesh, targets, options);
    std::vector<Result> results;
    size_t last = 0;  // the triangles of the last result
    size_t next = 0;
    for (; next < targets.size() && mesh.triangles.size() <= targets[next]; ++next) {
        results.push_back(whole(mesh));
        last = mesh.triangles.size();
    }
    if (next == targets.size())
        return results;
    Adjacency adjacency;
    CollapseMesh working = open_collapse_mesh(mesh, job, others, &adjacency);
    if (working.live == 0) {
        for (; next < targets.size() && !tracked; ++next)
            results.push_back(whole(first_triangles(mesh, targets[next])));
        return results;
    }
    const size_t start = working.live;
    const size_t goal = targets.back();
    CollapseReducer reducer(working, options);
    std::optional<LevelFitter> fitter;
    if (options.mode == SimplifyMode::Best && others.empty())
        fitter.emplace(mesh, working, options, !tracked && !options.keep_topology);
    for (; next < targets.size(); ++next) {
        const auto report = [&] {
            if (start > goal)
                job.progress(static_cast<double>(start - working.live) /
                             static_cast<double>(start - goal));
        };
        reducer.reduce(targets[next], job, report, adjacency);
        const bool reached = working.live <= targets[next];
        // Where collapsing stops before the target, the mesh so far is the last result, unless it
        // is one already.
        if (reached || results.empty() || working.live < last) {
            fit_surface(working, mesh, adjacency, kFastFit, job);
            if (fitter) {
                Adjacency around;
                CollapseMesh level = fitter->fit(working, adjacency, around, job);
                results.push_back(taken(level, fit_attributes(level, mesh, around, job)));
            } else {
                results.push_back(taken(working, fit_attributes(working, mesh, adjacency, job)));
            }
            last = working.live;
        }
        if (!reached)
            break;
    }
    job.progress(1);
    return results;
}

}  // namespace

std::vector<Mesh> simplify_chain(const Mesh& mesh, std::span<const size_t> targets,
                                 const SimplifyOptions& options, const Job& job) {
    return chain<Mesh>(
        mesh, {}, false, targets, options, job, [](const Mesh& given) { return given; },
        [](const CollapseMesh& working, std::span<const glm::vec3> normals) {
            return extract(working, nullptr, normals);
        });
}

std::vector<TracedLevel> simplify_traced(const Mesh& mesh,
                                         std::span<const std::vector<glm::vec3>> others,
                                         std::span<const size_t> targets,
                                         const SimplifyOptions& options, const Job& job) {
    for (const std::vector<glm::vec3>& positions : others) {
        if (positions.size() != mesh.positions.size())
            fail(Status::InvalidArgument, "a pose of ", positions.size(), " positions for ",
                 mesh.positions.size(), " vertices");
    }
    return chain<TracedLevel>(mesh, others, true, targets, options, job, untouched, traced);
}

Mesh simplify_mesh(const Mesh& mesh, size_t triangles, const SimplifyOptions& options,
                   const Job& job) {
    std::vector<Mesh> chain =
        simplify_chain(mesh, std::span<const size_t>(&triangles, 1), options, job);
    return std::move(chain.back());
}

}  // namespace lodestone::simplify
