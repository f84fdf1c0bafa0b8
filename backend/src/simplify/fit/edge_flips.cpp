// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/fit/edge_flips.h"

#include "base/parallel.h"

#include <algorithm>
#include <cmath>

namespace lodestone::simplify {
namespace {

/// The cost of a turned normal: the square of its error times this share of the size of the two
/// triangles.
/// Fitted: by tests/bench/peers/bench_simplify.py, nine shared models at four targets.
constexpr float kTurn = 0.02f;
/// The share that a flip must save of the cost of the two triangles' samples.
/// Taste: a larger share flips fewer edges back and forth.
constexpr float kLeastGain = 0.1f;
/// The fewest samples on both triangles.
/// Taste: fewer do not tell which edge is nearer.
constexpr size_t kFewest = 5;
/// Twice the area over the square of the longest edge, as in collapses: thinner triangles are not
/// made.
/// Taste: a larger number refuses more flips and leaves fewer slivers.
constexpr float kThin = 4e-3f;
// The most triangles around a vertex whose edges are flipped.
// Taste: more take longer at hubs.
constexpr size_t kMostFlipRing = 64;
// Triangles that one thread looks at at a time.
// Taste: larger chunks share the work less evenly.
constexpr size_t kFlipChunk = 4096;

/// Two triangles (a, b, c) and (b, a, d), which after the flip are (a, d, c) and (d, b, c).
struct FlipQuad {
    uint32_t t0, t1;
    uint32_t a, b, c, d;
    int at0, at1;  // the corner of a in t0, that of b in t1
    float gain;
};

glm::vec3 unit(const glm::vec3& v) {
    const float length = glm::length(v);
    return length > 0 ? v / length : glm::vec3(0.0f);
}

class EdgeFlipper {
public:
    EdgeFlipper(FitPlaces& places, const Adjacency& adjacency, FitSamples& samples);
    size_t flip(const Job& job);

private:
    struct FacetPair {
        glm::vec3 first, second;
    };
    bool find_quad(uint32_t triangle, int corner, FlipQuad& quad) const;
    bool has_edge(uint32_t u, uint32_t w) const;
    bool seam(const FlipQuad& quad) const;
    bool allows(const FlipQuad& quad, const FacetPair& before, const FacetPair& after) const;
    float gain_of(const FlipQuad& quad) const;
    void apply(const FlipQuad& quad);
    glm::vec3 facet(uint32_t u, uint32_t v, uint32_t w) const {
        return 0.5f * glm::cross(points_[v] - points_[u], points_[w] - points_[u]);
    }
    /// True on the side of triangle (d, b, c) of the plane through c and d.
    struct FlipPlane {
        glm::vec3 from, normal;
        bool second(const glm::vec3& point) const { return glm::dot(point - from, normal) > 0; }
    };
    FlipPlane cut_of(const FlipQuad& quad, const FacetPair& before) const;

    FitPlaces& places_;
    CollapseMesh& mesh_;
    const Adjacency& adjacency_;
    const std::vector<glm::vec3>& points_;
    FitSamples& samples_;
    SamplesByTriangle by_triangle_;
    std::vector<glm::vec3> normals_;  // normals of the original, by sample
};

EdgeFlipper::EdgeFlipper(FitPlaces& places, const Adjacency& adjacency, FitSamples& samples)
    : places_(places),
      mesh_(places.mesh()),
      adjacency_(adjacency),
      points_(places.points()),
      samples_(samples),
      by_triangle_(places, samples) {
    const Mesh& source = places.source();
    normals_.resize(samples.size());
    for (size_t i = 0; i < samples.size(); ++i) {
        // Each triangle has two samples, one after the other.
        if (i > 0 && samples[i].source == samples[i - 1].source) {
            normals_[i] = normals_[i - 1];
            continue;
        }
        const Triangle& t = source.triangles[samples[i].source];
        const glm::vec3 a = places.original(t.x);
        normals_[i] = unit(glm::cross(places.original(t.y) - a, places.original(t.z) - a));
    }
}

bool EdgeFlipper::find_quad(uint32_t triangle, int corner, FlipQuad& quad) const {
    const Triangle& t = mesh_.triangles[triangle];
    quad = {triangle, kNone, t[corner], t[(corner + 1) % 3], t[(corner + 2) % 3], kNone,
            corner,   0,     0};
    const uint32_t hub = adjacency_.valence(quad.a) <= adjacency_.valence(quad.b) ? quad.a : quad.b;
    if (adjacency_.valence(hub) > kMostFlipRing)
        return false;
    for (const uint32_t near : adjacency_.around(hub)) {
        if (near == triangle)
            continue;
        const Triangle& n = mesh_.triangles[near];
        for (int i = 0; i < 3; ++i) {
            const uint32_t u = n[i];
            const uint32_t w = n[(i + 1) % 3];
            if (u == quad.a && w == quad.b)
                return false;
            if (u != quad.b || w != quad.a)
                continue;
            if (quad.t1 != kNone)
                return false;
            quad.t1 = near;
            quad.at1 = i;
            quad.d = n[(i + 2) % 3];
        }
    }
    return quad.t1 != kNone && quad.c != quad.d;
}

bool EdgeFlipper::has_edge(uint32_t u, uint32_t w) const {
    if (adjacency_.valence(u) > adjacency_.valence(w))
        std::swap(u, w);
    if (adjacency_.valence(u) > kMostFlipRing)
        return true;
    const std::span<const uint32_t> ring = adjacency_.around(u);
    return std::any_of(ring.begin(), ring.end(), [&](uint32_t t) {
        const Triangle& n = mesh_.triangles[t];
        return n.x == w || n.y == w || n.z == w;
    });
}

bool EdgeFlipper::seam(const FlipQuad& q) const {
    if (!mesh_.slots.empty() && mesh_.slots[q.t0] != mesh_.slots[q.t1])
        return true;
    if (mesh_.wedges.empty())
        return false;
    const Triangle& w0 = mesh_.wedges[q.t0];
    const Triangle& w1 = mesh_.wedges[q.t1];
    const uint32_t a = w0[q.at0];
    const uint32_t b = w0[(q.at0 + 1) % 3];
    if (a != w1[(q.at1 + 1) % 3] || b != w1[q.at1])
        return true;
    if (mesh_.uvs.empty())
        return false;
    // The texture must not fold over.
    const glm::vec2& at_a = mesh_.uvs[a];
    const glm::vec2& at_b = mesh_.uvs[b];
    const glm::vec2& at_c = mesh_.uvs[w0[(q.at0 + 2) % 3]];
    const glm::vec2& at_d = mesh_.uvs[w1[(q.at1 + 2) % 3]];
    const auto area = [](const glm::vec2& u, const glm::vec2& v, const glm::vec2& w) {
        return (v.x - u.x) * (w.y - u.y) - (v.y - u.y) * (w.x - u.x);
    };
    const float sum = area(at_a, at_b, at_c) + area(at_b, at_a, at_d);
    return !(area(at_a, at_d, at_c) * sum >= 0 && area(at_d, at_b, at_c) * sum >= 0);
}

bool EdgeFlipper::allows(const FlipQuad& q, const FacetPair& before, const FacetPair& after) const {
    const glm::vec3 sum = before.first + before.second;
    for (const glm::vec3& facet : {after.first, after.second}) {
        const float dot = glm::dot(facet, sum);
        if (!(dot > 0 && 4 * dot * dot >= glm::dot(facet, facet) * glm::dot(sum, sum)))
            return false;
    }
    const auto square = [&](uint32_t u, uint32_t w) {
        const glm::vec3 edge = points_[w] - points_[u];
        return glm::dot(edge, edge);
    };
    const float across = square(q.c, q.d);
    const float longest0 = std::max({across, square(q.a, q.d), square(q.c, q.a)});
    const float longest1 = std::max({across, square(q.d, q.b), square(q.b, q.c)});
    return 2 * glm::length(after.first) >= kThin * longest0 &&
           2 * glm::length(after.second) >= kThin * longest1;
}

EdgeFlipper::FlipPlane EdgeFlipper::cut_of(const FlipQuad& q, const FacetPair& before) const {
    const glm::vec3 normal = glm::cross(before.first + before.second, points_[q.d] - points_[q.c]);
    const bool toward_b = glm::dot(points_[q.b] - points_[q.c], normal) > 0;
    return {points_[q.c], toward_b ? normal : -normal};
}

float EdgeFlipper::gain_of(const FlipQuad& q) const {
    const size_t count = by_triangle_.on(q.t0).size() + by_triangle_.on(q.t1).size();
    if (count < kFewest || seam(q) || has_edge(q.c, q.d))
        return 0;
    const FacetPair before{mesh_.facets[q.t0], mesh_.facets[q.t1]};
    const FacetPair after{facet(q.a, q.d, q.c), facet(q.d, q.b, q.c)};
    if (!allows(q, before, after))
        return 0;
    const glm::vec3 was[2] = {unit(before.first), unit(before.second)};
    const glm::vec3 is[2] = {unit(after.first), unit(after.second)};
    const float turn = kTurn * glm::length(before.first + before.second);
    const FlipPlane cut = cut_of(q, before);
    float old_cost = 0;
    float new_cost = 0;
    float old_most = 0;
    float new_most = 0;
    for (int side = 0; side < 2; ++side) {
        const uint32_t t = side == 0 ? q.t0 : q.t1;
        for (const PlacedSample& sample : by_triangle_.on(t)) {
            const glm::vec3& point = sample.place;
            const glm::vec3& normal = normals_[sample.index];
            const int now = cut.second(point) ? 1 : 0;
            const float miss = glm::dot(point - points_[q.c], is[now]);
            old_most = std::max(old_most, std::abs(sample.miss));
            new_most = std::max(new_most, std::abs(miss));
            old_cost += sample.area *
                        (sample.miss * sample.miss + turn * (1 - glm::dot(normal, was[side])));
            new_cost += sample.area * (miss * miss + turn * (1 - glm::dot(normal, is[now])));
        }
    }
    const float gain = old_cost - new_cost;
    return gain > kLeastGain * old_cost && new_most <= old_most ? gain : 0;
}

void EdgeFlipper::apply(const FlipQuad& q) {
    const FacetPair before{mesh_.facets[q.t0], mesh_.facets[q.t1]};
    const FlipPlane cut = cut_of(q, before);
    if (!mesh_.wedges.empty()) {
        Triangle& w0 = mesh_.wedges[q.t0];
        Triangle& w1 = mesh_.wedges[q.t1];
        const uint32_t a = w0[q.at0];
        const uint32_t b = w0[(q.at0 + 1) % 3];
        const uint32_t c = w0[(q.at0 + 2) % 3];
        const uint32_t d = w1[(q.at1 + 2) % 3];
        w0 = Triangle(a, d, c);
        w1 = Triangle(d, b, c);
    }
    mesh_.triangles[q.t0] = Triangle(q.a, q.d, q.c);
    mesh_.triangles[q.t1] = Triangle(q.d, q.b, q.c);
    for (const uint32_t t : {q.t0, q.t1})
        mesh_.facets[t] = glm::vec3(mesh_.facet_of(mesh_.triangles[t]));
    const auto move = [&](const PlacedSample& placed) {
        const glm::vec3& point = placed.place;
        FitSample& sample = samples_[placed.index];
        sample.triangle = cut.second(point) ? q.t1 : q.t0;
        const Triangle& t = mesh_.triangles[sample.triangle];
        const glm::vec3 weights = geometry::nearest_weights(
            points_[t.x] - point, points_[t.y] - point, points_[t.z] - point);
        const glm::vec3 normal = unit(mesh_.facets[sample.triangle]);
        for (int i = 0; i < 3; ++i)
            sample.weights[i] = weights[i];
        sample.toward = normal;
        sample.miss = glm::dot(normal, point - points_[t.x]);
        if (!std::isfinite(sample.miss + weights.x + weights.y + weights.z))
            sample.area = sample.miss = sample.weights[0] = sample.weights[1] = sample.weights[2] =
                0;
    };
    for (const uint32_t t : {q.t0, q.t1})
        std::ranges::for_each(by_triangle_.on(t), move);
}

size_t EdgeFlipper::flip(const Job& job) {
    const size_t count = mesh_.triangles.size();
    std::vector<std::vector<FlipQuad>> found((count + kFlipChunk - 1) / kFlipChunk);
    parallel_for(found.size(), [&](size_t chunk) {
        job.check();
        const size_t last = std::min(count, (chunk + 1) * kFlipChunk);
        for (size_t t = chunk * kFlipChunk; t < last; ++t) {
            for (int corner = 0; corner < 3; ++corner) {
                FlipQuad quad{};
                const Triangle& corners = mesh_.triangles[t];
                if (corners[corner] > corners[(corner + 1) % 3] ||
                    !find_quad(static_cast<uint32_t>(t), corner, quad))
                    continue;
                quad.gain = gain_of(quad);
                if (quad.gain > 0)
                    found[chunk].push_back(quad);
            }
        }
    });
    std::vector<FlipQuad> quads;
    for (const std::vector<FlipQuad>& some : found)
        quads.insert(quads.end(), some.begin(), some.end());
    std::stable_sort(quads.begin(), quads.end(),
                     [](const FlipQuad& x, const FlipQuad& y) { return x.gain > y.gain; });
    std::vector<uint8_t> touched(points_.size(), 0);
    size_t flipped = 0;
    for (const FlipQuad& q : quads) {
        if (touched[q.a] || touched[q.b] || touched[q.c] || touched[q.d])
            continue;
        touched[q.a] = touched[q.b] = touched[q.c] = touched[q.d] = 1;
        apply(q);
        ++flipped;
    }
    return flipped;
}

}  // namespace

size_t flip_edges(FitPlaces& places, const Adjacency& adjacency, const Job& job,
                  FitSamples& samples) {
    if (samples.empty())
        return 0;
    return EdgeFlipper(places, adjacency, samples).flip(job);
}

}  // namespace lodestone::simplify
