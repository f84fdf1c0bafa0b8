// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel.h"
#include "simplify/fit/fit_samples.h"

#include <algorithm>
#include <cmath>

namespace lodestone::simplify {
namespace {

// The most triangles around a vertex that are searched.
// Taste: more find nearer places at hubs, more slowly.
constexpr size_t kMostSearchRing = 32;
// The most steps from vertex to vertex.
// Taste: more find nearer places, more slowly.
constexpr int kMostWalkSteps = 4;

/// The triangles of the original that one thread samples at a time.
/// Taste: larger chunks share the work less evenly.
constexpr size_t kSearchChunk = 4096;
// How many triangles ahead memory is asked for.
// Taste: more displace what is still needed, fewer come too late.
constexpr size_t kSamplesAhead = 8;

class SurfaceSampler {
public:
    SurfaceSampler(const FitPlaces& places, const Adjacency& adjacency)
        : places_(places), mesh_(places.mesh()), adjacency_(adjacency), points_(places.points()) {}
    /// Writes two samples; the triangle of a sample that does not exist is kNone. `nearest`:
    /// triangles that they may lie above, or kNone.
    void sample(uint32_t source, int corner, const uint32_t* nearest, FitSample* samples) const;

private:
    void take(uint32_t source, const glm::vec3& point, uint32_t from, const glm::vec3& normal,
              float area, uint32_t nearest, FitSample& sample) const;
    /// Whether the point lies above or below that triangle, with the normal on the same side.
    bool above(const glm::vec3& point, const glm::vec3& normal, uint32_t triangle,
               geometry::TriangleSpot& spot) const;

    const FitPlaces& places_;
    const CollapseMesh& mesh_;
    const Adjacency& adjacency_;
    const std::vector<glm::vec3>& points_;
};

bool SurfaceSampler::above(const glm::vec3& point, const glm::vec3& normal, uint32_t triangle,
                           geometry::TriangleSpot& spot) const {
    const Triangle& c = mesh_.triangles[triangle];
    const glm::vec3& facet = mesh_.facets[triangle];
    const float agree = glm::dot(facet, normal);
    if (!(agree > 0 && agree * agree > 0.25f * glm::dot(facet, facet)))
        return false;
    const glm::vec3 a = points_[c.x] - point;
    const glm::vec3 b = points_[c.y] - point;
    const glm::vec3 d = points_[c.z] - point;
    const float x = glm::dot(facet, glm::cross(b, d));
    const float y = glm::dot(facet, glm::cross(d, a));
    const float z = glm::dot(facet, glm::cross(a, b));
    const float sum = x + y + z;
    if (!(x >= 0 && y >= 0 && z >= 0 && sum > 0))
        return false;
    const float scale = 1 / sum;
    spot = {0, triangle, glm::vec3(x * scale, y * scale, z * scale)};
    return true;
}

void SurfaceSampler::take(uint32_t source, const glm::vec3& point, uint32_t from,
                          const glm::vec3& normal, float area, uint32_t nearest,
                          FitSample& sample) const {
    if (from == kNone)
        return;
    geometry::TriangleSpot best;
    uint32_t at = from;
    bool found = nearest != kNone && above(point, normal, nearest, best);
    for (int step = 0; step < kMostWalkSteps && !found; ++step) {
        const std::span<const uint32_t> whole = adjacency_.around(at);
        const std::span<const uint32_t> ring = whole.first(std::min(whole.size(), kMostSearchRing));
        // It mostly lies above one of them.
        for (const uint32_t t : ring) {
            found = above(point, normal, t, best);
            if (found)
                break;
        }
        if (found)
            break;
        const auto corners = [&](uint32_t t) {
            const Triangle& c = mesh_.triangles[t];
            return geometry::TrianglePoints{points_[c.x], points_[c.y], points_[c.z]};
        };
        geometry::nearest_of_triangles(ring, point, corners, best);
        if (best.triangle == kNone)
            return;
        const Triangle& c = mesh_.triangles[best.triangle];
        // Where the nearest point lies on the far side, the triangle beyond may be nearer.
        const int corner = best.weights.x >= best.weights.y
                               ? (best.weights.x >= best.weights.z ? 0 : 2)
                               : (best.weights.y >= best.weights.z ? 1 : 2);
        const bool within = best.weights.x > 0 && best.weights.y > 0 && best.weights.z > 0;
        if (within || c[corner] == at)
            break;
        at = c[corner];
    }
    const Triangle& c = mesh_.triangles[best.triangle];
    glm::vec3 toward = point - (best.weights.x * points_[c.x] + best.weights.y * points_[c.y] +
                                best.weights.z * points_[c.z]);
    const bool inside = best.weights.x > 0 && best.weights.y > 0 && best.weights.z > 0;
    const glm::vec3 facet(mesh_.facets[best.triangle]);
    const float length = glm::length(facet);
    if (!(length > 0) || glm::dot(facet, normal) < 0.3f * length)
        return;
    const glm::vec3 direction = inside ? facet / length : normal;
    const float miss = glm::dot(direction, toward);
    toward = direction;
    if (!std::isfinite(miss + toward.x + toward.y + toward.z))
        return;
    sample = {best.triangle, source, {best.weights.x, best.weights.y, best.weights.z},
              toward,        miss,   area};
}

void SurfaceSampler::sample(uint32_t source, int corner, const uint32_t* nearest,
                            FitSample* samples) const {
    samples[0].triangle = samples[1].triangle = kNone;
    const Triangle& t = places_.source().triangles[source];
    const uint32_t from = places_.place(t.x);
    if (from == kNone)
        return;
    const glm::vec3 a = places_.original(t.x);
    const glm::vec3 b = places_.original(t.y);
    const glm::vec3 c = places_.original(t.z);
    const glm::vec3 facet = glm::cross(b - a, c - a);
    const float area = glm::length(facet);
    if (!(area > 0))
        return;
    take(source, (a + b + c) * (1.0f / 3), from, facet / area, 0.75f * area, nearest[0],
         samples[0]);
    take(source, corner == 0 ? a : (corner == 1 ? b : c), places_.place(t[corner]), facet / area,
         0.25f * area, nearest[1], samples[1]);
}

}  // namespace

FitPlaces::FitPlaces(CollapseMesh& mesh, const Mesh& source)
    : mesh_(mesh), source_(source), per_scale_(1 / mesh.scale) {
    // A vertex that was merged into a merged one now belongs to the vertex that is left.
    std::vector<uint32_t>& merged = mesh.merged;
    for (uint32_t id = 0; id < merged.size(); ++id) {
        uint32_t root = merged[id];
        while (merged[root] != root) {
            merged[root] = merged[merged[root]];
            root = merged[root];
        }
        merged[id] = root;
    }
    place_of_.assign(merged.size(), kNone);
    for (uint32_t v = 0; v < mesh.ids.size(); ++v)
        place_of_[mesh.ids[v]] = v;
    points_.reserve(mesh.points.size());
    for (const glm::dvec3& point : mesh.points)
        points_.emplace_back(point);
}

void FitPlaces::add(uint32_t vertex, uint32_t original) {
    const auto id = static_cast<uint32_t>(mesh_.merged.size());
    mesh_.ids.push_back(id);
    mesh_.merged.push_back(id);
    mesh_.sources.push_back(kNone);
    place_of_.push_back(vertex);
    if (original != kNone && mesh_.merged[original] != original)
        mesh_.merged[original] = id;
}

SamplesByTriangle::SamplesByTriangle(const FitPlaces& places, const FitSamples& samples) {
    const std::vector<Triangle>& triangles = places.mesh().triangles;
    const std::vector<glm::vec3>& points = places.points();
    first_.assign(triangles.size() + 1, 0);
    for (const FitSample& sample : samples)
        first_[sample.triangle + 1] += sample.source != kNone;
    for (size_t t = 1; t < first_.size(); ++t)
        first_[t] += first_[t - 1];
    order_.resize(first_.back());
    std::vector<uint32_t> next(first_.begin(), first_.end() - 1);
    for (uint32_t i = 0; i < samples.size(); ++i) {
        const FitSample& sample = samples[i];
        if (sample.source == kNone)
            continue;
        const Triangle& c = triangles[sample.triangle];
        order_[next[sample.triangle]++] = {
            sample.weights[0] * points[c.x] + sample.weights[1] * points[c.y] +
                sample.weights[2] * points[c.z] + sample.miss * sample.toward,
            i, sample.source, sample.miss, sample.area};
    }
}

void sample_surface(const FitPlaces& places, const Adjacency& adjacency, size_t want, size_t more,
                    const Job& job, FitSamples& samples, std::vector<uint32_t>* nearest) {
    // The samples are vertices and middles in turn, as many as wanted, spread evenly.
    const size_t count = places.source().triangles.size();
    const double step = std::max(1.0, static_cast<double>(count) / static_cast<double>(want));
    const auto steps = static_cast<size_t>(std::ceil(static_cast<double>(count) / step));
    const SurfaceSampler sampler(places, adjacency);
    samples.clear();
    samples.reserve(2 * steps + more);
    samples.resize(2 * steps);
    std::vector<uint32_t> unknown;
    std::vector<uint32_t>& triangles = nearest != nullptr ? *nearest : unknown;
    triangles.resize(samples.size(), kNone);
    parallel_for((steps + kSearchChunk - 1) / kSearchChunk, [&](size_t chunk) {
        job.check();
        const auto nth = [&](size_t n) {
            return std::min(static_cast<size_t>(step * static_cast<double>(n)), count - 1);
        };
        const size_t end = std::min(steps, (chunk + 1) * kSearchChunk);
        for (size_t n = chunk * kSearchChunk; n < end; ++n) {
            // The triangles of scans are in no order: the next ones are asked for ahead.
            const size_t ahead = std::min(n + kSamplesAhead, end - 1);
            const Triangle& coming = places.source().triangles[nth(ahead)];
            for (const uint32_t vertex : {coming.x, coming.y, coming.z})
                places.prefetch_place(vertex);
            for (const uint32_t t : {triangles[2 * ahead], triangles[2 * ahead + 1]}) {
                if (t != kNone) {
                    __builtin_prefetch(&places.mesh().triangles[t]);
                    __builtin_prefetch(&places.mesh().facets[t]);
                }
            }
            sampler.sample(static_cast<uint32_t>(nth(n)), static_cast<int>(n % 3),
                           &triangles[2 * n], &samples[2 * n]);
            triangles[2 * n] = samples[2 * n].triangle;
            triangles[2 * n + 1] = samples[2 * n + 1].triangle;
        }
    });
    const auto none = [](const FitSample& sample) { return sample.triangle == kNone; };
    samples.erase(std::remove_if(samples.begin(), samples.end(), none), samples.end());
}

}  // namespace lodestone::simplify
