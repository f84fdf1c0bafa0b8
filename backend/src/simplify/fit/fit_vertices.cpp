// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/fit/fit_samples.h"

#include <algorithm>
#include <cmath>

namespace lodestone::simplify {
namespace {

/// The weight of a vertex, relative to the samples of the surface around it.
/// Fitted: by tests/bench/peers/bench_simplify.py, nine shared models at four targets.
constexpr float kWeight = 0.3f;
/// A vertex sticks out if it is this many times the samples' spacing away from all of them.
/// Taste: a smaller number searches for more vertices.
constexpr float kFar = 2;
/// A miss of less than this many times the misses of the samples around is ignored.
/// Fitted: by tests/bench/peers/bench_simplify.py, largest distance of nine shared models.
constexpr float kTypical = 4;
// The most triangles around a vertex that are searched.
// Taste: more find nearer samples at hubs, more slowly.
constexpr size_t kMostRing = 32;

/// The vertices that are visited before the original is searched for what is nearest to them,
/// because its memory lies anywhere.
/// Taste: more displace what is still needed, fewer come too late.
constexpr size_t kAtOnce = 64;

/// The triangle of the original whose sample on the ring is nearest to a vertex, the number of
/// these samples, and the sums of their areas and squared misses.
struct NearestSample {
    uint32_t vertex = kNone;
    uint32_t source = kNone;
    float square = 1e30f;
    float area = 0;
    float squares = 0;
    size_t count = 0;
};

NearestSample nearest_to(uint32_t vertex, const glm::vec3& point, std::span<const uint32_t> ring,
                         const SamplesByTriangle& by_triangle) {
    NearestSample nearest{vertex};
    for (const uint32_t t : ring) {
        for (const PlacedSample& sample : by_triangle.on(t)) {
            const glm::vec3 off = sample.place - point;
            nearest.area += sample.area;
            nearest.squares += sample.area * sample.miss * sample.miss;
            ++nearest.count;
            const float square = glm::dot(off, off);
            if (square < nearest.square) {
                nearest.square = square;
                nearest.source = sample.source;
            }
        }
    }
    return nearest;
}

}  // namespace

void sample_vertices(FitPlaces& places, const Adjacency& adjacency, FitSamples& samples) {
    const CollapseMesh& mesh = places.mesh();
    const Mesh& source = places.source();
    const std::vector<glm::vec3>& points = places.points();
    const SamplesByTriangle by_triangle(places, samples);
    const auto append = [&](const NearestSample& nearest) {
        const uint32_t v = nearest.vertex;
        const Triangle& t = source.triangles[nearest.source];
        const glm::vec3 a = places.original(t.x) - points[v];
        const glm::vec3 b = places.original(t.y) - points[v];
        const glm::vec3 c = places.original(t.z) - points[v];
        const glm::vec3 weights = geometry::nearest_weights(a, b, c);
        const glm::vec3 off = weights.x * a + weights.y * b + weights.z * c;
        const float distance = glm::length(off);
        const glm::vec3 facet = glm::cross(b - a, c - a);
        const float twice = glm::length(facet);
        if (!(distance > 0) || !(twice > 0))
            return;
        const float spacing = std::sqrt(nearest.area / static_cast<float>(nearest.count));
        const bool far = distance > kFar * spacing;
        // Beside the triangle, another one that has no sample may be nearer.
        if (!far && !(weights.x > 0 && weights.y > 0 && weights.z > 0))
            return;
        const glm::vec3 toward = far ? off / distance : facet / twice;
        const uint32_t triangle = adjacency.around(v).front();
        const Triangle& corners = mesh.triangles[triangle];
        const float share = kWeight * nearest.area / static_cast<float>(3);
        const float miss = glm::dot(toward, off);
        const float least = kTypical * std::sqrt(nearest.squares / nearest.area);
        if (!(std::abs(miss) > least))
            return;
        FitSample sample{triangle, kNone, {0, 0, 0}, toward, miss > 0 ? miss - least : miss + least,
                         share};
        sample.weights[corners.x == v ? 0 : (corners.y == v ? 1 : 2)] = 1;
        if (std::isfinite(sample.miss + share + toward.x + toward.y + toward.z))
            samples.push_back(sample);
    };
    std::vector<NearestSample> some;
    some.reserve(kAtOnce);
    for (size_t first = 0; first < points.size(); first += kAtOnce) {
        some.clear();
        for (size_t v = first; v < std::min(points.size(), first + kAtOnce); ++v) {
            const auto vertex = static_cast<uint32_t>(v);
            const std::span<const uint32_t> whole = adjacency.around(vertex);
            const std::span<const uint32_t> ring = whole.first(std::min(whole.size(), kMostRing));
            const NearestSample nearest = nearest_to(vertex, points[v], ring, by_triangle);
            if (nearest.source == kNone)
                continue;
            __builtin_prefetch(&source.triangles[nearest.source]);
            some.push_back(nearest);
        }
        std::for_each(some.begin(), some.end(), append);
    }
}

}  // namespace lodestone::simplify
