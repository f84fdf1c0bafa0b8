// SPDX-License-Identifier: GPL-3.0-or-later
#include "approximate/edges.h"

#include "approximate/edge_costs.h"
#include "base/parallel.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

namespace lodestone::approximate {
namespace {

int corner_of(const Triangle& t, uint32_t vertex) {
    return t.x == vertex ? 0 : (t.y == vertex ? 1 : 2);
}

/// A plane through the edge, upright on the triangle: moving across it costs, along it does not.
void hold_edge(Quadric& quadric, const glm::dvec3& edge, const glm::dvec3& facet, double weight) {
    const double square = glm::dot(edge, edge);
    const double area = glm::length(facet);
    if (!(square > 0))
        return;
    if (area > 1e-12 * square) {
        const glm::dvec3 normal = glm::cross(edge, facet);
        // |edge x facet|^2 = square area^2: the weight is that of a square on the edge.
        quadric.add(normal, weight / (area * area));
        return;
    }
    // No area, no plane: hold it in both directions across.
    quadric.xx += weight * square;
    quadric.yy += weight * square;
    quadric.zz += weight * square;
    quadric.add(edge, -weight);
}

/// By how much the colors on both sides of an edge miss being one linear ramp, where the nearer of
/// the two opposite corners is: 0 inside a smooth ramp, up to 1 where paint ends. As a picture
/// encodes colors, roughly.
double color_kink(const CollapseMesh& mesh, const Triangle& t0, const Triangle& w0,
                  const Triangle& t1, const Triangle& w1, uint32_t a, uint32_t b) {
    const auto color = [&](uint32_t wedge) {
        return glm::sqrt(glm::clamp(mesh.colors[wedge], 0.0f, 1.0f));
    };
    const glm::dvec3 edge = mesh.points[b] - mesh.points[a];
    const double square = glm::dot(edge, edge);
    if (!(square > 0))
        return 0;
    glm::vec4 slopes[2];
    double heights[2] = {0, 0};
    for (int side = 0; side < 2; ++side) {
        const Triangle& t = side == 0 ? t0 : t1;
        const Triangle& w = side == 0 ? w0 : w1;
        const int at_a = corner_of(t, a);
        const int at_b = corner_of(t, b);
        const int opposite = 3 - at_a - at_b;
        const glm::dvec3 arm = mesh.points[t[opposite]] - mesh.points[a];
        const double along = glm::dot(arm, edge) / square;
        heights[side] = glm::length(arm - along * edge);
        const auto s = static_cast<float>(along);
        slopes[side] = color(w[opposite]) - (1 - s) * color(w[at_a]) - s * color(w[at_b]);
    }
    const double least = std::min(heights[0], heights[1]);
    if (!(least > 1e-9 * std::sqrt(square)))
        return 0;
    const glm::vec4 kink = glm::abs(slopes[0] * static_cast<float>(least / heights[0]) +
                                    slopes[1] * static_cast<float>(least / heights[1]));
    return std::min(1.0, static_cast<double>(std::max({kink.x, kink.y, kink.z, kink.w})));
}

/// Finds the neighbors of a vertex whose triangles form one closed fan, all turned alike: the usual
/// case, in which no table is needed. False: any other.
template <typename Neighbor>
bool find_in_fan(const CollapseMesh& mesh, std::span<const uint32_t> ring, uint32_t vertex,
                 std::vector<Neighbor>& neighbors) {
    constexpr size_t kMost = 16;
    const size_t count = ring.size();
    if (count > kMost)
        return false;
    uint32_t to[kMost];
    uint32_t from[kMost];
    for (size_t i = 0; i < count; ++i) {
        const Triangle& t = mesh.triangles[ring[i]];
        const bool first = t.x == vertex;
        const bool second = t.y == vertex;
        to[i] = first ? t.y : (second ? t.z : t.x);
        from[i] = first ? t.z : (second ? t.x : t.y);
    }
    uint32_t met = 0;
    for (size_t i = 0; i < count; ++i) {
        uint32_t at = 0;
        uint32_t matches = 0;
        for (uint32_t j = 0; j < count; ++j) {
            const bool same = from[j] == to[i];
            matches += same;
            at = same ? j : at;
        }
        if (matches != 1)
            return false;
        met |= 1u << at;
        neighbors.push_back({to[i], 2, ring[i], ring[at], true, false});
    }
    return met == (1u << count) - 1;
}

/// Of any vertex.
template <typename Neighbor>
void find_any(const CollapseMesh& mesh, std::span<const uint32_t> ring, uint32_t vertex,
              std::vector<Neighbor>& neighbors) {
    constexpr size_t kFew = 64;
    const size_t end = 2 * ring.size();
    const auto other_end = [&](size_t i) {
        const Triangle& corners = mesh.triangles[ring[i / 2]];
        return corners[(corner_of(corners, vertex) + 1 + static_cast<int>(i & 1u)) % 3];
    };
    // (neighbor, index of its use): hubs are sorted, all others searched.
    std::vector<std::pair<uint32_t, size_t>> uses;
    if (end > kFew) {
        for (size_t i = 0; i < end; ++i)
            uses.emplace_back(other_end(i), i);
        std::sort(uses.begin(), uses.end());
    }
    for (size_t n = 0; n < end; ++n) {
        const size_t i = uses.empty() ? n : uses[n].second;
        const uint32_t other = other_end(i);
        const uint32_t t = ring[i / 2];
        const bool leaving = (i & 1u) == 0;
        Neighbor* known = nullptr;
        if (!uses.empty()) {
            if (!neighbors.empty() && neighbors.back().vertex == other)
                known = &neighbors.back();
        } else {
            for (Neighbor& each : neighbors) {
                if (each.vertex == other)
                    known = &each;
            }
        }
        if (known == nullptr) {
            neighbors.push_back({other, 1, t, kNone, leaving, false});
        } else if (++known->uses == 2) {
            known->t1 = t;
            known->leaving1 = leaving;
        }
    }
}

constexpr size_t kChunk = 8192;

}  // namespace

void Edges::visit(const CollapseMesh& mesh, const Adjacency& adjacency,
                  const SimplifyOptions& options, uint32_t vertex, Chunk& chunk) {
    const std::span<const uint32_t> ring = adjacency.around(vertex);
    const auto add_planes = [&](const std::vector<glm::vec3>& facets, Quadric& quadric) {
        glm::vec3 sum(0.0f);
        float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
        for (const uint32_t t : ring) {
            const glm::vec3 facet = facets[t];
            sum += facet;
            const float square = glm::dot(facet, facet);
            const float weight = square > 1e-37f ? 1 / std::sqrt(square) : 0.0f;
            const glm::vec3 scaled = weight * facet;
            xx += facet.x * scaled.x;
            xy += facet.x * scaled.y;
            xz += facet.x * scaled.z;
            yy += facet.y * scaled.y;
            yz += facet.y * scaled.z;
            zz += facet.z * scaled.z;
        }
        quadric += Quadric{xx, xy, xz, yy, yz, zz};
        return sum;
    };
    Quadric quadric;
    const glm::vec3 sum = add_planes(mesh.facets, quadric);
    std::vector<Quadric> quadrics(others_.size());
    std::vector<Neighbor>& neighbors = chunk.neighbors;
    neighbors.clear();
    const bool fan = find_in_fan(mesh, ring, vertex, neighbors);
    if (!fan) {
        neighbors.clear();
        find_any(mesh, ring, vertex, neighbors);
    }
    const bool plain = fan && mesh.slots.empty() && mesh.wedges.empty() && mesh.colors.empty();
    int borders = 0;
    for (const Neighbor& n : neighbors) {
        const bool two = n.uses == 2;
        if (n.vertex > vertex)
            chunk.edges.push_back({vertex, n.vertex, n.t0, two ? n.t1 : kNone});
        if (plain)
            continue;
        borders += !two;
        double weight = two ? 0 : options.boundary_weight;
        if (two && !mesh.slots.empty() && mesh.slots[n.t0] != mesh.slots[n.t1])
            weight = options.boundary_weight;
        if (two && weight <= 0) {
            bool crease = n.leaving0 == n.leaving1;
            if (!mesh.wedges.empty() && !crease) {
                const Triangle& first = mesh.triangles[n.t0];
                const Triangle& second = mesh.triangles[n.t1];
                for (const uint32_t end : {vertex, n.vertex})
                    crease |= mesh.wedges[n.t0][corner_of(first, end)] !=
                              mesh.wedges[n.t1][corner_of(second, end)];
            }
            if (crease)
                weight = options.seam_weight;
        }
        if (two && !mesh.colors.empty() && weight < options.boundary_weight) {
            constexpr double kLeastKink = 0.1;
            const double kink =
                color_kink(mesh, mesh.triangles[n.t0], mesh.wedges[n.t0], mesh.triangles[n.t1],
                           mesh.wedges[n.t1], vertex, n.vertex);
            if (kink > kLeastKink)
                weight = std::max(weight, kink * options.boundary_weight);
        }
        if (weight > 0) {
            const auto hold = [&](const std::vector<glm::dvec3>& points,
                                  const std::vector<glm::vec3>& facets, Quadric& held) {
                const glm::dvec3 edge = points[n.vertex] - points[vertex];
                hold_edge(held, edge, glm::dvec3(facets[n.t0]), weight);
                if (n.t1 != kNone)
                    hold_edge(held, edge, glm::dvec3(facets[n.t1]), weight);
            };
            hold(mesh.points, mesh.facets, quadric);
            for (size_t i = 0; i < others_.size(); ++i)
                hold(mesh.others[i].points, mesh.others[i].facets, quadrics[i]);
        }
    }
    const auto around = [](const glm::dvec3& point, const glm::vec3& facet, const Quadric& q) {
        const auto f = [](double value) { return static_cast<float>(value); };
        return Around{glm::vec3(point), facet,   f(q.xx), f(q.xy),
                      f(q.xz),          f(q.yy), f(q.yz), f(q.zz)};
    };
    own_[vertex] = around(mesh.points[vertex], sum, quadric);
    for (size_t i = 0; i < others_.size(); ++i) {
        const glm::vec3 other_sum = add_planes(mesh.others[i].facets, quadrics[i]);
        others_[i][vertex] = around(mesh.others[i].points[vertex], other_sum, quadrics[i]);
    }
    kinds_[vertex] = borders == 0   ? VertexKind::Free
                     : borders == 2 ? VertexKind::Curve
                                    : VertexKind::Fixed;
}

void Edges::build(const CollapseMesh& mesh, const Adjacency& adjacency,
                  const SimplifyOptions& options, const Job& job) {
    const size_t vertices = mesh.points.size();
    own_.resize(vertices);
    others_.resize(mesh.others.size());
    for (std::vector<Around>& other : others_)
        other.resize(vertices);
    kinds_.resize(vertices);
    chunks_.resize((vertices + kChunk - 1) / kChunk);
    parallel_for(chunks_.size(), [&](size_t i) {
        job.check();
        Chunk& chunk = chunks_[i];
        chunk.edges.clear();
        chunk.edges.reserve(kChunk * 3 + kChunk / 4);
        const size_t last = std::min(vertices, (i + 1) * kChunk);
        for (size_t v = i * kChunk; v < last; ++v)
            visit(mesh, adjacency, options, static_cast<uint32_t>(v), chunk);
    });
}

void Edges::rank(const CollapseMesh& mesh, Effort effort, const Job& job) {
    parallel_for(chunks_.size(), [&](size_t i) {
        job.check();
        rank(mesh, effort, chunks_[i]);
    });
    counts_.assign(1u << 16u, 0);
    possible_ = 0;
    for (const Chunk& chunk : chunks_) {
        for (const uint32_t key : chunk.keys) {
            ++counts_[key >> 16u];
            possible_ += key < kImpossible;
        }
    }
}

void Edges::rank(const CollapseMesh& mesh, Effort effort, Chunk& chunk) const {
    chunk.keys.resize(chunk.edges.size());
    if (!others_.empty()) {
        for (size_t i = 0; i < chunk.edges.size(); ++i) {
            const Edge& edge = chunk.edges[i];
            chunk.keys[i] = allowed(edge, effort)
                                ? key_of_cost(static_cast<float>(optimum(mesh, edge, effort).cost))
                                : kImpossible;
        }
        return;
    }
    EdgeBlock block;
    for (size_t start = 0; start < chunk.edges.size(); start += EdgeBlock::kSize) {
        const size_t count = std::min(chunk.edges.size() - start, EdgeBlock::kSize);
        for (size_t i = 0; i < count; ++i) {
            const Edge& edge = chunk.edges[start + i];
            glm::vec3 shared = mesh.facets[edge.t0];
            if (edge.t1 != kNone)
                shared += mesh.facets[edge.t1];
            const Around& a = own_[edge.a];
            const Around& b = own_[edge.b];
            const bool fixed_a = kinds_[edge.a] == VertexKind::Fixed;
            const bool fixed_b = kinds_[edge.b] == VertexKind::Fixed;
            // 0: free, -1 or 1: at the end that may not move.
            const bool held = fixed_a != fixed_b || (fixed_a && effort < Effort::Topology);
            const float end = held ? (fixed_a ? -1.0f : 1.0f) : 0.0f;
            const float in[EdgeBlock::kInputs] = {0.5f * (b.point.x - a.point.x),
                                                  0.5f * (b.point.y - a.point.y),
                                                  0.5f * (b.point.z - a.point.z),
                                                  a.xx,
                                                  a.xy,
                                                  a.xz,
                                                  a.yy,
                                                  a.yz,
                                                  a.zz,
                                                  b.xx,
                                                  b.xy,
                                                  b.xz,
                                                  b.yy,
                                                  b.yz,
                                                  b.zz,
                                                  b.facet.x - a.facet.x,
                                                  b.facet.y - a.facet.y,
                                                  b.facet.z - a.facet.z,
                                                  b.facet.x + a.facet.x - shared.x,
                                                  b.facet.y + a.facet.y - shared.y,
                                                  b.facet.z + a.facet.z - shared.z,
                                                  end};
            for (size_t k = 0; k < EdgeBlock::kInputs; ++k)
                block.in[k][i] = in[k];
        }
        edge_costs(block);
        for (size_t i = 0; i < count; ++i)
            chunk.keys[start + i] =
                allowed(chunk.edges[start + i], effort) ? key_of_cost(block.cost[i]) : kImpossible;
    }
}

uint32_t Edges::key_of(size_t count) const {
    size_t sum = 0;
    for (size_t i = 0; i < counts_.size(); ++i) {
        sum += counts_[i];
        if (sum > count)
            return (static_cast<uint32_t>(i) << 16u) | 0xffffu;
    }
    return kImpossible - 1;
}

void Edges::take(uint32_t limit, std::vector<Candidate>& candidates) const {
    limit = std::min(limit, kImpossible - 1);
    candidates.clear();
    for (const Chunk& chunk : chunks_) {
        for (size_t i = 0; i < chunk.keys.size(); ++i) {
            if (chunk.keys[i] <= limit)
                candidates.push_back({chunk.edges[i], chunk.keys[i]});
        }
    }
}

bool Edges::allowed(const Edge& edge, Effort effort) const {
    if (effort >= Effort::Topology)
        return true;
    const VertexKind a = kinds_[edge.a];
    const VertexKind b = kinds_[edge.b];
    if (a == VertexKind::Fixed && b == VertexKind::Fixed)
        return false;
    // An inner edge between two border points: collapsing it would pinch the surface.
    return edge.border() || a == VertexKind::Free || b == VertexKind::Free;
}

Optimum Edges::optimum_in(const std::vector<glm::dvec3>& points,
                          const std::vector<glm::vec3>& facets, const std::vector<Around>& around,
                          const Edge& edge, Effort effort) const {
    const EdgeEnd a{points[edge.a], around[edge.a].quadric(), glm::dvec3(around[edge.a].facet)};
    const EdgeEnd b{points[edge.b], around[edge.b].quadric(), glm::dvec3(around[edge.b].facet)};
    const bool fixed_a = kinds_[edge.a] == VertexKind::Fixed;
    const bool fixed_b = kinds_[edge.b] == VertexKind::Fixed;
    if (fixed_a != fixed_b || (fixed_a && effort < Effort::Topology)) {
        const glm::dvec3& point = fixed_a ? a.point : b.point;
        return {point, cost_at(a, b, point)};
    }
    glm::dvec3 shared(facets[edge.t0]);
    if (edge.t1 != kNone)
        shared += glm::dvec3(facets[edge.t1]);
    return best_point(a, b, shared);
}

Optimum Edges::optimum(const CollapseMesh& mesh, const Edge& edge, Effort effort) const {
    Optimum best = optimum_in(mesh.points, mesh.facets, own_, edge, effort);
    for (size_t i = 0; i < others_.size(); ++i) {
        const OtherPose& pose = mesh.others[i];
        best.cost += optimum_in(pose.points, pose.facets, others_[i], edge, effort).cost;
    }
    return best;
}

void Edges::other_points(const CollapseMesh& mesh, const Edge& edge, Effort effort,
                         std::vector<glm::dvec3>& points) const {
    points.clear();
    for (size_t i = 0; i < others_.size(); ++i) {
        const OtherPose& pose = mesh.others[i];
        points.push_back(optimum_in(pose.points, pose.facets, others_[i], edge, effort).point);
    }
}

}  // namespace lodestone::approximate
