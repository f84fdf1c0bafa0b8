// SPDX-License-Identifier: GPL-3.0-or-later
#include "approximate/edges.h"

#include "approximate/neighbors.h"
#include "base/parallel.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace lodestone::approximate {
namespace {

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

Quadric quadric_of(const VertexAround& around) {
    return {around.xx, around.xy, around.xz, around.yy, around.yz, around.zz};
}

constexpr uint32_t kChunk = 8192;
/// Vertices whose edges are asked what they cost before all are.
constexpr uint32_t kSampled = 2048;
constexpr uint32_t kRun = 8;  // of them in a row

/// The bits by which candidates are ordered, and how many values these have.
constexpr size_t kSteps = (kImpossible >> kKeyShift) + 1;

}  // namespace

void Edges::visit(const CollapseMesh& mesh, const Adjacency& adjacency,
                  const SimplifyOptions& options, uint32_t vertex, Neighbors& neighbors,
                  Chunk* borders) {
    const std::span<const uint32_t> ring = adjacency.around(vertex);
    for (const uint32_t t : adjacency.ahead(vertex)) {
        __builtin_prefetch(&mesh.triangles[t]);
        __builtin_prefetch(&mesh.facets[t]);
    }
    const auto add_planes = [&](const std::vector<glm::vec3>& facets, Quadric& quadric) {
        glm::vec3 sum(0.0f);
        float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
        for (const uint32_t t : ring) {
            // By the component: copies of vectors go through memory, and wait for it.
            const float x = facets[t].x;
            const float y = facets[t].y;
            const float z = facets[t].z;
            sum += glm::vec3(x, y, z);
            const float square = x * x + y * y + z * z;
            const float weight = square > 1e-37f ? 1 / std::sqrt(square) : 0.0f;
            const float wx = weight * x;
            const float wy = weight * y;
            const float wz = weight * z;
            xx += x * wx;
            xy += x * wy;
            xz += x * wz;
            yy += y * wy;
            yz += y * wz;
            zz += z * wz;
        }
        quadric += Quadric{xx, xy, xz, yy, yz, zz};
        return sum;
    };
    Quadric quadric;
    const glm::vec3 sum = add_planes(mesh.facets, quadric);
    std::vector<Quadric> quadrics(others_.size());
    const bool fan = neighbors.find_fan(mesh, ring, vertex);
    const bool plain = fan && mesh.slots.empty() && mesh.wedges.empty() && mesh.colors.empty();
    int open = 0;
    std::span<const Neighbors::Neighbor> found;
    if (!plain)
        found = neighbors.find(mesh, ring, vertex, fan);
    for (const Neighbors::Neighbor& n : found) {
        const bool two = n.uses == 2;
        if (!two && n.vertex > vertex && borders != nullptr)
            borders->borders.emplace_back(vertex, n.vertex);
        open += !two;
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
        return VertexAround{glm::vec3(point), facet,   f(q.xx), f(q.xy),
                            f(q.xz),          f(q.yy), f(q.yz), f(q.zz)};
    };
    own_[vertex] = around(mesh.points[vertex], sum, quadric);
    for (size_t i = 0; i < others_.size(); ++i) {
        const glm::vec3 other_sum = add_planes(mesh.others[i].facets, quadrics[i]);
        others_[i][vertex] = around(mesh.others[i].points[vertex], other_sum, quadrics[i]);
    }
    kinds_[vertex] = open == 0   ? VertexKind::Free
                     : open == 2 ? VertexKind::Curve
                                 : VertexKind::Fixed;
}

void Edges::build(const CollapseMesh& mesh, const Adjacency& adjacency,
                  const SimplifyOptions& options, bool borders, const Job& job) {
    const size_t vertices = mesh.points.size();
    own_.resize(vertices);
    others_.resize(mesh.others.size());
    for (std::vector<VertexAround>& other : others_)
        other.resize(vertices);
    kinds_.resize(vertices);
    chunks_.resize((vertices + kChunk - 1) / kChunk);
    parallel_for(chunks_.size(), [&](size_t i) {
        job.check();
        Chunk& chunk = chunks_[i];
        chunk.first = static_cast<uint32_t>(i * kChunk);
        chunk.last = static_cast<uint32_t>(std::min(vertices, (i + 1) * kChunk));
        chunk.borders.clear();
        Neighbors neighbors;
        for (uint32_t v = chunk.first; v < chunk.last; ++v)
            visit(mesh, adjacency, options, v, neighbors, borders ? &chunk : nullptr);
    });
}

void Edges::clear() {
    chunks_ = {};
    own_ = {};
    others_ = {};
    kinds_ = {};
}

/// What edges cost, a block of them at a time.
class Edges::Pricing {
public:
    Pricing(const Edges& edges, const CollapseMesh& mesh, const Adjacency& adjacency, Effort effort)
        : edges_(edges), mesh_(mesh), adjacency_(adjacency), effort_(effort) {}

    /// Calls take(candidate) for every edge of which `vertex` is the lower end and that may be
    /// collapsed, at the latest in flush().
    template <typename Take>
    void price(uint32_t vertex, const Take& take) {
        const std::span<const uint32_t> ring = adjacency_.around(vertex);
        for (const uint32_t t : adjacency_.ahead(vertex))
            __builtin_prefetch(&mesh_.triangles[t]);
        if (neighbors_.find_fan(mesh_, ring, vertex)) {
            for (uint32_t i = 0; i < ring.size(); ++i) {
                if (neighbors_.corner(i) > vertex)
                    price(vertex, neighbors_.corner(i), ring[i], ring[neighbors_.before(i)], take);
            }
            return;
        }
        for (const Neighbors::Neighbor& n : neighbors_.find(mesh_, ring, vertex, false)) {
            if (n.vertex > vertex)
                price(vertex, n.vertex, n.t0, n.uses == 2 ? n.t1 : kNone, take);
        }
    }

    template <typename Take>
    void flush(const Take& take) {
        if (count_ == 0)
            return;
        for (size_t i = 0; i < count_; ++i)
            block_.in[i] = input_of(waiting_[i]);
        edge_costs(block_);
        for (size_t i = 0; i < count_; ++i) {
            const uint32_t key = key_of_cost(block_.cost[i]);
            if (key < kImpossible)
                take(Candidate{waiting_[i].a, waiting_[i].b, key});
        }
        count_ = 0;
    }

private:
    struct Waiting {
        uint32_t a, b, t0, t1;
    };
    /// t1: kNone where it is not shared by exactly two triangles.
    template <typename Take>
    void price(uint32_t a, uint32_t b, uint32_t t0, uint32_t t1, const Take& take) {
        if (!edges_.allowed(a, b, t1 == kNone, effort_))
            return;
        if (edges_.others_.empty()) {
            add(a, b, t0, t1);
            if (count_ == EdgeBlock::kSize)
                flush(take);
            return;
        }
        const uint32_t shared[2] = {t0, t1};
        const std::span<const uint32_t> on(shared, t1 == kNone ? 1 : 2);
        const double cost = edges_.optimum(mesh_, a, b, on, effort_).cost;
        const uint32_t key = key_of_cost(static_cast<float>(cost));
        if (key < kImpossible)
            take(Candidate{a, b, key});
    }

    /// Only asks for what it is priced by: that has come when a block of edges is full.
    void add(uint32_t a, uint32_t b, uint32_t t0, uint32_t t1) {
        __builtin_prefetch(&edges_.own_[b]);
        __builtin_prefetch(&mesh_.facets[t0]);
        if (t1 != kNone)
            __builtin_prefetch(&mesh_.facets[t1]);
        waiting_[count_++] = {a, b, t0, t1};
    }

    EdgeInput input_of(const Waiting& edge) const {
        glm::vec3 shared = mesh_.facets[edge.t0];
        if (edge.t1 != kNone)
            shared += mesh_.facets[edge.t1];
        const bool fixed_a = edges_.kinds_[edge.a] == VertexKind::Fixed;
        const bool fixed_b = edges_.kinds_[edge.b] == VertexKind::Fixed;
        const bool held = fixed_a != fixed_b || (fixed_a && effort_ < Effort::Topology);
        return {edges_.own_[edge.a], edges_.own_[edge.b], shared,
                held ? (fixed_a ? -1.0f : 1.0f) : 0.0f};
    }

    const Edges& edges_;
    const CollapseMesh& mesh_;
    const Adjacency& adjacency_;
    Effort effort_;
    Neighbors neighbors_;
    EdgeBlock block_{};
    std::array<Waiting, EdgeBlock::kSize> waiting_;
    size_t count_ = 0;
};

uint32_t Edges::key_of(const CollapseMesh& mesh, const Adjacency& adjacency, Effort effort,
                       size_t count) const {
    const auto vertices = static_cast<uint32_t>(mesh.points.size());
    const uint32_t step = std::max(vertices / kSampled, 1u) * kRun;
    std::vector<uint32_t> keys;
    keys.reserve(size_t{kSampled} * 4);
    const auto take = [&](const Candidate& candidate) { keys.push_back(candidate.key); };
    Pricing pricing(*this, mesh, adjacency, effort);
    uint32_t sampled = 0;
    for (uint32_t first = 0; first < vertices; first += step) {
        const uint32_t last = std::min(vertices, first + kRun);
        for (uint32_t v = first; v < last; ++v)
            pricing.price(v, take);
        sampled += last - first;
    }
    pricing.flush(take);
    const double part = static_cast<double>(sampled) / static_cast<double>(vertices);
    const auto at = static_cast<size_t>(part * static_cast<double>(count));
    if (at >= keys.size())
        return kImpossible - 1;
    const auto middle = keys.begin() + static_cast<std::ptrdiff_t>(at);
    std::nth_element(keys.begin(), middle, keys.end());
    return *middle;
}

void Edges::take(const CollapseMesh& mesh, const Adjacency& adjacency, Effort effort,
                 uint32_t limit, const Job& job) {
    parallel_for(chunks_.size(), [&](size_t i) {
        job.check();
        Chunk& chunk = chunks_[i];
        std::vector<Candidate> taken;
        taken.reserve(chunk.last - chunk.first);
        std::vector<uint32_t> starts(kSteps + 1, 0);
        const auto take = [&](const Candidate& candidate) {
            if (candidate.key > limit)
                return;
            taken.push_back(candidate);
            ++starts[(candidate.key >> kKeyShift) + 1];
        };
        Pricing pricing(*this, mesh, adjacency, effort);
        for (uint32_t v = chunk.first; v < chunk.last; ++v)
            pricing.price(v, take);
        pricing.flush(take);
        for (size_t k = 0; k < kSteps; ++k)
            starts[k + 1] += starts[k];
        chunk.candidates.resize(taken.size());
        for (const Candidate& candidate : taken)
            chunk.candidates[starts[candidate.key >> kKeyShift]++] = candidate;
    });
}

bool Edges::allowed(uint32_t a, uint32_t b, bool border, Effort effort) const {
    if (effort >= Effort::Topology)
        return true;
    if (kinds_[a] == VertexKind::Fixed && kinds_[b] == VertexKind::Fixed)
        return false;
    // An inner edge between two border points: collapsing it would pinch the surface.
    return border || kinds_[a] == VertexKind::Free || kinds_[b] == VertexKind::Free;
}

Optimum Edges::optimum_in(const std::vector<glm::dvec3>& points,
                          const std::vector<glm::vec3>& facets,
                          const std::vector<VertexAround>& around, uint32_t a, uint32_t b,
                          std::span<const uint32_t> shared, Effort effort) const {
    const EdgeEnd end_a{points[a], quadric_of(around[a]), glm::dvec3(around[a].facet)};
    const EdgeEnd end_b{points[b], quadric_of(around[b]), glm::dvec3(around[b].facet)};
    const bool fixed_a = kinds_[a] == VertexKind::Fixed;
    const bool fixed_b = kinds_[b] == VertexKind::Fixed;
    if (fixed_a != fixed_b || (fixed_a && effort < Effort::Topology)) {
        const glm::dvec3& point = fixed_a ? end_a.point : end_b.point;
        return {point, cost_at(end_a, end_b, point)};
    }
    glm::dvec3 both(0.0);
    for (const uint32_t t : shared)
        both += glm::dvec3(facets[t]);
    return best_point(end_a, end_b, both);
}

Optimum Edges::optimum(const CollapseMesh& mesh, uint32_t a, uint32_t b,
                       std::span<const uint32_t> shared, Effort effort) const {
    Optimum best = optimum_in(mesh.points, mesh.facets, own_, a, b, shared, effort);
    for (size_t i = 0; i < others_.size(); ++i) {
        const OtherPose& pose = mesh.others[i];
        best.cost += optimum_in(pose.points, pose.facets, others_[i], a, b, shared, effort).cost;
    }
    return best;
}

void Edges::other_points(const CollapseMesh& mesh, uint32_t a, uint32_t b,
                         std::span<const uint32_t> shared, Effort effort,
                         std::vector<glm::dvec3>& points) const {
    points.clear();
    for (size_t i = 0; i < others_.size(); ++i) {
        const OtherPose& pose = mesh.others[i];
        points.push_back(
            optimum_in(pose.points, pose.facets, others_[i], a, b, shared, effort).point);
    }
}

}  // namespace lodestone::approximate
