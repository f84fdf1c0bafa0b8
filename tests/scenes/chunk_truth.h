// SPDX-License-Identifier: GPL-3.0-or-later
// Chunk truth: how far off the chunks of a large surface's levels are, by many points of each.
#pragma once

#include "base/parallel.h"
#include "measure/deviation/surface_samples.h"
#include "model/representation.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace lodestone::chunks {

/// The distance that one value in a thousand exceeds.
inline double quantile_of(std::vector<double> values) {
    if (values.empty())
        return 0;
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 999 / 1000);
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

/// The triangles of the finest in each chunk.
inline std::vector<std::vector<uint32_t>> triangles_by_chunk(const Mesh& finest,
                                                             const SurfaceTree& tree) {
    std::vector<std::vector<uint32_t>> out(tree.chunks());
    for (uint32_t t = 0; t < finest.triangles.size(); ++t)
        out[tree.chunk_of(finest, t)].push_back(t);
    return out;
}

/// Points of some triangles, uniform in their area.
inline std::vector<glm::dvec3> points_on(const Mesh& mesh, const ray::MeshScene& scene,
                                         const std::vector<uint32_t>& triangles) {
    constexpr uint32_t kPoints = 8192;
    constexpr uint64_t kSeed = 77;
    std::vector<measure::SurfaceSample> samples;
    measure::add_area_samples(mesh, scene, triangles, kPoints, kSeed, samples);
    std::vector<glm::dvec3> points;
    points.reserve(samples.size());
    for (const measure::SurfaceSample& sample : samples)
        points.push_back(sample.point);
    return points;
}

/// How far off each node of a level is: the 99.9 % quantile of the distances, the worse of both
/// ways.
inline std::vector<double> true_errors(const Mesh& finest, const Representation& level) {
    const SurfaceLevel& surface = *level.surface;
    const ray::MeshScene finest_scene(finest);
    const ray::MeshScene scene(level.mesh());
    const auto by_chunk = triangles_by_chunk(finest, *surface.tree);
    std::vector<double> out(surface.nodes());
    parallel_for(out.size(), [&](size_t node) {
        const auto off = [](const std::vector<glm::dvec3>& points, const ray::MeshScene& to) {
            std::vector<double> distances;
            distances.reserve(points.size());
            for (const glm::dvec3& point : points)
                distances.push_back(to.closest_point(point).distance);
            return quantile_of(std::move(distances));
        };
        std::vector<uint32_t> theirs;
        for (size_t chunk = node << surface.shift; chunk < (node + 1) << surface.shift; ++chunk)
            theirs.insert(theirs.end(), by_chunk[chunk].begin(), by_chunk[chunk].end());
        std::vector<uint32_t> own(surface.triangles_of(static_cast<uint32_t>(node)));
        std::iota(own.begin(), own.end(), surface.before[node]);
        out[node] = std::max(off(points_on(finest, finest_scene, theirs), scene),
                             off(points_on(level.mesh(), scene, own), finest_scene));
    });
    return out;
}

}  // namespace lodestone::chunks
