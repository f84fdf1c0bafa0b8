// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/fit/corner_normals.h"

#include "base/parallel.h"
#include "simplify/fit/wedge_normals.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <span>
#include <utility>

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
/// The fewest samples on a triangle.
/// Taste: fewer do not tell its shading.
constexpr size_t kSamplesToShade = 4;
/// The mean square difference of normals above which a triangle is shaded anew, and the part of it
/// that one normal for all of the triangle may then leave: a rim is in it, or noise of a scan.
/// Taste: 0.001 is 1.8 degrees, which an eye sees on a flat face.
constexpr float kLeastOff = 0.001f;
// Taste: a larger part makes facets of what curves.
constexpr float kLeft = 0.25f;
/// The cosine of corners at one vertex that share a normal.
/// Taste: 0.98 is 11 degrees; a larger cosine keeps more creases and more normals.
constexpr float kAlike = 0.98f;
// Triangles that one thread computes at a time.
// Taste: larger chunks share the work less evenly.
constexpr size_t kTrianglesAtOnce = 2048;

bool shaded(const glm::vec3& normal) {
    return normal != glm::vec3(0.0f);
}

/// The mean square difference between the normals of samples and those blended from the corners'.
float off_by(const glm::vec3* corners, const FitSamples& samples, std::span<const PlacedSample> on,
             const Mesh& source) {
    float sum = 0;
    float area = 0;
    for (const PlacedSample& placed : on) {
        const FitSample& s = samples[placed.index];
        const glm::vec3 normal = normal_at(source, s);
        const glm::vec3 blend =
            s.weights[0] * corners[0] + s.weights[1] * corners[1] + s.weights[2] * corners[2];
        const float length = glm::length(blend);
        const glm::vec3 off = normal - (length > 0 ? blend / length : blend);
        sum += s.area * glm::dot(off, off);
        area += s.area;
    }
    return area > 0 ? sum / area : 0;
}

/// The original's normal on a triangle where that is flat and its wedges lean; zero elsewhere.
glm::vec3 flat_normal(const CollapseMesh& mesh, uint32_t triangle, const FitSamples& samples,
                      std::span<const PlacedSample> on, const Mesh& source) {
    const glm::vec3 none(0.0f);
    if (on.size() < kSamplesToShade)
        return none;
    glm::vec3 sum(0.0f);
    for (const PlacedSample& placed : on) {
        const FitSample& sample = samples[placed.index];
        const glm::vec3 normal = normal_at(source, sample);
        if (!shaded(normal))
            return none;
        sum += sample.area * normal;
    }
    const float length = glm::length(sum);
    if (!(length > 0) || !std::isfinite(length))
        return none;
    const glm::vec3 mean = sum / length;
    const glm::vec3 flat[3] = {mean, mean, mean};
    const Triangle& wedges = mesh.wedges[triangle];
    const glm::vec3 carried[3] = {mesh.normals[wedges.x], mesh.normals[wedges.y],
                                  mesh.normals[wedges.z]};
    const float before = off_by(carried, samples, on, source);
    return before > kLeastOff && off_by(flat, samples, on, source) < kLeft * before ? mean : none;
}

/// Gives corners at `vertex` that come out alike, of wedges that were alike, their mean.
void share_normals(const CollapseMesh& mesh, const Adjacency& adjacency, uint32_t vertex,
                   std::vector<glm::vec3>& normals) {
    struct SharedNormal {
        glm::vec3 first;
        glm::vec3 carried;
        glm::vec3 sum;
    };
    std::vector<SharedNormal> found;
    std::vector<std::pair<uint32_t, uint32_t>> members;  // corner, index in `found`
    for (const uint32_t t : adjacency.around(vertex)) {
        for (uint32_t corner = 0; corner < 3; ++corner) {
            const uint32_t at = 3 * t + corner;
            if (mesh.triangles[t][static_cast<int>(corner)] != vertex || !shaded(normals[at]))
                continue;
            const glm::vec3 carried = mesh.normals[mesh.wedges[t][static_cast<int>(corner)]];
            const auto alike =
                std::find_if(found.begin(), found.end(), [&](const SharedNormal& one) {
                    return glm::dot(one.first, normals[at]) > kAlike &&
                           glm::dot(one.carried, carried) > kOneWedge;
                });
            const auto index = static_cast<uint32_t>(alike - found.begin());
            if (alike == found.end())
                found.push_back({normals[at], carried, glm::vec3(0.0f)});
            found[index].sum += glm::length(mesh.facets[t]) * normals[at];
            members.emplace_back(at, index);
        }
    }
    for (const auto& [at, index] : members) {
        const float length = glm::length(found[index].sum);
        if (length > 0)
            normals[at] = found[index].sum / length;
    }
}

}  // namespace

std::vector<glm::vec3> corner_normals(CollapseMesh& mesh, const Mesh& source,
                                      const Adjacency& adjacency, const Job& job) {
    if (mesh.normals.empty() || mesh.live == 0 || mesh.ids.empty())
        return {};
    const FitPlaces places(mesh, source);
    const double want = std::min(kSourcesEach * static_cast<double>(mesh.live),
                                 kMostSources * static_cast<double>(source.triangles.size()));
    FitSamples samples;
    sample_surface(places, adjacency, std::max(static_cast<size_t>(want), kLeastSources), 0, job,
                   samples);
    fit_wedge_normals(mesh, source, adjacency, samples);
    const size_t count = mesh.triangles.size();
    const SamplesByTriangle by_triangle(places, samples);
    std::vector<glm::vec3> normals(3 * count, glm::vec3(0.0f));
    std::atomic<bool> any{false};
    parallel_for((count + kTrianglesAtOnce - 1) / kTrianglesAtOnce, [&](size_t chunk) {
        job.check();
        const size_t end = std::min(count, (chunk + 1) * kTrianglesAtOnce);
        for (size_t t = chunk * kTrianglesAtOnce; t < end; ++t) {
            const auto triangle = static_cast<uint32_t>(t);
            const glm::vec3 flat =
                flat_normal(mesh, triangle, samples, by_triangle.on(triangle), source);
            if (!shaded(flat))
                continue;
            std::fill_n(&normals[3 * t], 3, flat);
            any.store(true, std::memory_order_relaxed);
        }
    });
    if (!any.load())
        return {};
    for (uint32_t v = 0; v < mesh.points.size(); ++v)
        share_normals(mesh, adjacency, v, normals);
    return normals;
}

}  // namespace lodestone::simplify
