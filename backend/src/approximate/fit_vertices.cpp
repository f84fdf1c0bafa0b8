// SPDX-License-Identifier: GPL-3.0-or-later
#include "approximate/fit_sample.h"

#include <algorithm>
#include <cmath>

namespace lodestone::approximate {
namespace {

/// Of a vertex relative to the samples of the surface around it.
constexpr float kWeight = 0.3f;
/// So many samples' spacing away from all of them it sticks out.
constexpr float kFar = 2;
/// Missing the surface by so many times what its samples miss is nothing.
constexpr float kTypical = 4;
constexpr size_t kMostAround = 32;

struct Nearest {
    float square = 1e30f;
    uint32_t source = kNone;
};

}  // namespace

void sample_vertices(FitPlaces& places, const Adjacency& adjacency, FitSamples& samples) {
    const CollapseMesh& mesh = places.mesh();
    const Mesh& source = places.source();
    const std::vector<glm::vec3>& points = places.points();
    const SamplesByTriangle by_triangle(places, samples);
    for (uint32_t v = 0; v < points.size(); ++v) {
        const std::span<const uint32_t> whole = adjacency.around(v);
        const std::span<const uint32_t> ring = whole.first(std::min(whole.size(), kMostAround));
        Nearest nearest;
        float area = 0;
        float squares = 0;
        size_t count = 0;
        for (const uint32_t t : ring) {
            for (const PlacedSample& sample : by_triangle.on(t)) {
                const glm::vec3 off = sample.place - points[v];
                area += sample.area;
                squares += sample.area * sample.miss * sample.miss;
                ++count;
                const float square = glm::dot(off, off);
                if (square < nearest.square)
                    nearest = {square, sample.source};
            }
        }
        if (nearest.source == kNone)
            continue;
        const Triangle& t = source.triangles[nearest.source];
        const glm::vec3 a = places.original(t.x) - points[v];
        const glm::vec3 b = places.original(t.y) - points[v];
        const glm::vec3 c = places.original(t.z) - points[v];
        const glm::vec3 weights = nearest_weights(a, b, c);
        const glm::vec3 off = weights.x * a + weights.y * b + weights.z * c;
        const float distance = glm::length(off);
        const glm::vec3 facet = glm::cross(b - a, c - a);
        const float twice = glm::length(facet);
        if (!(distance > 0) || !(twice > 0))
            continue;
        const float spacing = std::sqrt(area / static_cast<float>(count));
        const bool far = distance > kFar * spacing;
        // Beside the triangle another one, of which there is no sample, may be nearer.
        if (!far && !(weights.x > 0 && weights.y > 0 && weights.z > 0))
            continue;
        const glm::vec3 toward = far ? off / distance : facet / twice;
        const uint32_t triangle = ring.front();
        const Triangle& corners = mesh.triangles[triangle];
        const float share = kWeight * area / static_cast<float>(3);
        const float miss = glm::dot(toward, off);
        const float least = kTypical * std::sqrt(squares / area);
        if (!(std::abs(miss) > least))
            continue;
        FitSample sample{triangle, kNone, {0, 0, 0}, toward, miss > 0 ? miss - least : miss + least,
                         share};
        sample.weights[corners.x == v ? 0 : (corners.y == v ? 1 : 2)] = 1;
        if (std::isfinite(sample.miss + share + toward.x + toward.y + toward.z))
            samples.push_back(sample);
    }
}

}  // namespace lodestone::approximate
