// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/fit/level_attributes.h"

#include "simplify/fit/corner_normals.h"
#include "simplify/fit/wedge_fit.h"

#include <algorithm>

namespace lodestone::simplify {
namespace {

/// The original's triangles that are sampled, for each triangle of the mesh.
/// Taste: more tell the shading of small triangles better, in more time.
constexpr double kSourcesEach = 16;
// The largest share of them.
// Taste: a larger one takes more time with levels near the original.
constexpr double kMostSources = 0.5;
// The fewest of them.
// Taste: fewer do not tell the shading of coarse levels.
constexpr size_t kLeastSources = 1000;
}  // namespace

std::vector<glm::vec3> fit_attributes(CollapseMesh& mesh, const Mesh& source,
                                      const Adjacency& adjacency, const Job& job) {
    if ((mesh.normals.empty() && mesh.uvs.empty()) || mesh.live == 0 || mesh.ids.empty())
        return {};
    FitPlaces places(mesh, source);
    const double want = std::min(kSourcesEach * static_cast<double>(mesh.live),
                                 kMostSources * static_cast<double>(source.triangles.size()));
    FitSamples samples;
    sample_surface(places, adjacency, std::max(static_cast<size_t>(want), kLeastSources), 0, job,
                   samples);
    if (!mesh.uvs.empty())
        fit_wedge_uvs(places, samples);
    if (mesh.normals.empty())
        return {};
    fit_wedge_normals(mesh, source, adjacency, samples);
    return corner_normals(places, adjacency, samples, job);
}

}  // namespace lodestone::simplify
