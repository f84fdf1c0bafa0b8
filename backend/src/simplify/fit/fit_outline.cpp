// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/fit/fit_samples.h"

#include <algorithm>
#include <cmath>

namespace lodestone::simplify {
namespace {

/// The weight of outlines, relative to the surface: an edge counts as this many squares on it.
/// Fitted: by tests/bench/peers/bench_simplify.py; other weights are in backend/EXPERIMENTS.md.
constexpr float kBorder = 2;
// The most steps along a border.
// Taste: more find nearer edges, more slowly.
constexpr int kMostOutlineSteps = 4;

/// The edge from a triangle's corner to the next corner, which lies on a border.
struct OutlineBorder {
    uint32_t triangle;
    int corner;
    uint32_t next;  // the next border of the same vertex
};

class OutlineSampler {
public:
    OutlineSampler(FitPlaces& places, const Adjacency& adjacency, FitSamples& samples)
        : places_(places),
          mesh_(places.mesh()),
          adjacency_(adjacency),
          points_(places.points()),
          samples_(samples) {}
    void sample(const Job& job);

private:
    void find_borders();
    void take(const glm::vec3& point, uint32_t from, const glm::vec3& edge, float weight);

    FitPlaces& places_;
    const CollapseMesh& mesh_;
    const Adjacency& adjacency_;
    const std::vector<glm::vec3>& points_;
    FitSamples& samples_;
    std::vector<uint32_t> heads_;  // the first border of each vertex
    std::vector<OutlineBorder> borders_;
};

void OutlineSampler::find_borders() {
    std::vector<uint8_t> outer(points_.size(), 0);
    for (const auto& [a, b] : mesh_.outline) {
        for (const uint32_t end : {places_.place(a), places_.place(b)}) {
            if (end != kNone)
                outer[end] = 1;
        }
    }
    heads_.assign(points_.size(), kNone);
    for (uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
        const Triangle& c = mesh_.triangles[t];
        for (int i = 0; i < 3; ++i) {
            const uint32_t u = c[i];
            const uint32_t w = c[(i + 1) % 3];
            if (!outer[u] || !outer[w])
                continue;
            const uint32_t hub = adjacency_.valence(u) <= adjacency_.valence(w) ? u : w;
            const uint32_t end = hub == u ? w : u;
            int uses = 0;
            for (const uint32_t near : adjacency_.around(hub)) {
                const Triangle& n = mesh_.triangles[near];
                uses += n.x == end || n.y == end || n.z == end;
            }
            if (uses != 1)
                continue;
            for (const uint32_t v : {u, w}) {
                borders_.push_back({t, i, heads_[v]});
                heads_[v] = static_cast<uint32_t>(borders_.size() - 1);
            }
        }
    }
}

void OutlineSampler::take(const glm::vec3& point, uint32_t from, const glm::vec3& edge,
                          float weight) {
    float least = 1e30f;
    const OutlineBorder* best = nullptr;
    float best_along = 0;
    uint32_t at = from;
    for (int step = 0; step < kMostOutlineSteps; ++step) {
        int looked = 0;
        for (uint32_t i = heads_[at]; i != kNone && looked < 8; i = borders_[i].next, ++looked) {
            const OutlineBorder& border = borders_[i];
            const Triangle& c = mesh_.triangles[border.triangle];
            const glm::vec3& start = points_[c[border.corner]];
            const glm::vec3 run = points_[c[(border.corner + 1) % 3]] - start;
            const float along =
                std::min(std::max(glm::dot(point - start, run) / glm::dot(run, run), 0.0f), 1.0f);
            const glm::vec3 off = start + along * run - point;
            const float square = glm::dot(off, off);
            if (square < least) {
                least = square;
                best = &border;
                best_along = along;
            }
        }
        if (best == nullptr)
            return;
        const Triangle& c = mesh_.triangles[best->triangle];
        const uint32_t nearer = c[(best->corner + (best_along > 0.5f ? 1 : 0)) % 3];
        if (nearer == at || (best_along > 0 && best_along < 1))
            break;
        at = nearer;
    }
    const Triangle& c = mesh_.triangles[best->triangle];
    const int next = (best->corner + 1) % 3;
    const glm::vec3& start = points_[c[best->corner]];
    const glm::vec3 run = points_[c[next]] - start;
    glm::vec3 toward = glm::cross(run, mesh_.facets[best->triangle]);
    const float length = glm::length(toward);
    const float agree = glm::dot(run, edge);
    if (!(length > 0) || !(agree * agree > 0.25f * glm::dot(run, run) * glm::dot(edge, edge)))
        return;
    toward /= length;
    FitSample sample{best->triangle, kNone, {0, 0, 0}, toward, 0, weight};
    sample.weights[best->corner] = 1 - best_along;
    sample.weights[next] = best_along;
    sample.miss = glm::dot(toward, point - (start + best_along * run));
    if (std::isfinite(sample.miss + toward.x + toward.y + toward.z))
        samples_.push_back(sample);
}

void OutlineSampler::sample(const Job& job) {
    find_borders();
    job.check();
    for (const auto& [first, second] : mesh_.outline) {
        const glm::vec3 a = places_.original(mesh_.sources[first]);
        const glm::vec3 b = places_.original(mesh_.sources[second]);
        const glm::vec3 edge = b - a;
        const float weight = kBorder * glm::dot(edge, edge);
        const uint32_t from = places_.place(first);
        if (from == kNone || !(weight > 0))
            continue;
        take(0.5f * (a + b), from, edge, weight);
        take(a, from, edge, 0.5f * weight);
    }
}

}  // namespace

void sample_outline(FitPlaces& places, const Adjacency& adjacency, const Job& job,
                    FitSamples& samples) {
    if (!places.mesh().outline.empty())
        OutlineSampler(places, adjacency, samples).sample(job);
}

}  // namespace lodestone::simplify
