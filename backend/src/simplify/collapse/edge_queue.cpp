// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/collapse/edge_queue.h"

#include "base/parallel.h"
#include "simplify/collapse/attribute_kink.h"
#include "simplify/collapse/edge_neighbors.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace lodestone::simplify {
namespace {

/// The weight of open borders, relative to that of paint: the surface ends there, and only that is
/// seen. With the same weight they keep triangles that the surface beside them needs more (leaves,
/// a car body, terrain).
/// Fitted: by tests/bench/peers/bench_simplify.py, silhouette and mean error of nine shared models.
constexpr double kOpen = 0.15;

/// The weight of edges where a texture is stretched otherwise on one side than on the other,
/// relative to that of seams. Where a surface is flat, only they tell where a vertex belongs.
/// Fitted: by four textured models (0.001 to 1): with 0.01 and more surfaces are farther off.
constexpr double kTextureKink = 0.003;

/// Edges that are held count as at least this share of the square of a typical edge, but at most
/// kMostRaised times what they are: the tip of an outline is as far away however short its edges
/// are.
/// Fitted: by tests/bench/peers/bench_simplify.py, nine shared models at four targets.
constexpr double kLeastSquare = 0.3;
// Taste: a larger number holds specks, too.
constexpr double kMostRaised = 1e4;
/// How many triangles apart are those whose area tells how long edges are.
/// Taste: fewer triangles tell it less exactly, in less time.
constexpr size_t kMeasured = 16;

/// The mean square of the length of edges, as if all triangles were equilateral.
double typical_square(const CollapseMesh& mesh) {
    double sum = 0;
    size_t count = 0;
    for (size_t i = 0; i < mesh.facets.size(); i += kMeasured, ++count)
        sum += glm::length(glm::dvec3(mesh.facets[i]));
    return count > 0 ? 4 / std::sqrt(3.0) * sum / static_cast<double>(count) : 0;
}

/// Adds a plane through the edge, upright on the triangle: moving across it costs, along it does
/// not. `least` is added to the edge's square.
void hold_edge(geometry::Quadric& quadric, const glm::dvec3& edge, const glm::dvec3& facet,
               double weight, double least) {
    const double square = glm::dot(edge, edge);
    const double area = glm::length(facet);
    if (!(square > 0))
        return;
    weight *= std::min(1 + least / square, kMostRaised);
    if (area > 1e-12 * square) {
        const glm::dvec3 normal = glm::cross(edge, facet);
        // |edge x facet|^2 = square area^2: the weight is that of a square on the edge.
        quadric.add(normal, weight / (area * area));
        return;
    }
    // A triangle without area gives no plane: hold the edge in both directions across it.
    quadric.xx += weight * square;
    quadric.yy += weight * square;
    quadric.zz += weight * square;
    quadric.add(edge, -weight);
}

geometry::Quadric quadric_of(const VertexAround& around) {
    return {around.xx, around.xy, around.xz, around.yy, around.yz, around.zz};
}

void add(VertexAround& around, const geometry::Quadric& q) {
    const auto f = [](double value) { return static_cast<float>(value); };
    around.xx += f(q.xx);
    around.xy += f(q.xy);
    around.xz += f(q.xz);
    around.yy += f(q.yy);
    around.yz += f(q.yz);
    around.zz += f(q.zz);
}

using Lanes = float __attribute__((vector_size(16)));

/// The surroundings of a vertex at `point`, from the planes of its triangles.
VertexAround around_of(const glm::dvec3& point, const std::vector<glm::vec3>& facets,
                       std::span<const uint32_t> ring) {
    Lanes sum{};
    Lanes squares{};   // the sums xx, yy, zz
    Lanes products{};  // the sums xy, yz, zx
    for (const uint32_t t : ring) {
        const glm::vec3& facet = facets[t];
        const float square = facet.x * facet.x + facet.y * facet.y + facet.z * facet.z;
        const float weight = square > 1e-37f ? 1 / std::sqrt(square) : 0.0f;
        const Lanes f{facet.x, facet.y, facet.z, 0};
        const Lanes weighted = weight * f;
        sum += f;
        squares += f * weighted;
        products += f * __builtin_shufflevector(weighted, weighted, 1, 2, 0, 3);
    }
    return {glm::vec3(point), glm::vec3(sum[0], sum[1], sum[2]),
            squares[0],       products[0],
            products[2],      squares[1],
            products[1],      squares[2]};
}

// The vertices of a chunk.
// Taste: larger chunks leave fewer edges between them and share the work less evenly.
constexpr uint32_t kChunk = 8192;
/// The vertices whose edges are priced before all are, to find the cost that a pass goes up to.
/// Taste: more find it more exactly, in more time.
constexpr uint32_t kSampled = 512;
// How many of these follow each other.
// Taste: longer runs read memory better and sample the mesh worse.
constexpr uint32_t kRun = 8;

/// The number of values of the bits by which candidates are ordered.
/// Law: one more than the largest key, shifted.
constexpr size_t kSteps = (kImpossible >> kKeyShift) + 1;

}  // namespace

void EdgeQueue::visit(const CollapseMesh& mesh, Adjacency& adjacency,
                      const SimplifyOptions& options, uint32_t vertex, VertexNeighbors& neighbors,
                      EdgeChunk* borders) {
    const std::span<uint32_t> ring = adjacency.around(vertex);
    for (const uint32_t t : adjacency.ahead(vertex)) {
        __builtin_prefetch(&mesh.triangles[t]);
        __builtin_prefetch(&mesh.facets[t]);
    }
    own_[vertex] = around_of(mesh.points[vertex], mesh.facets, ring);
    for (size_t i = 0; i < others_.size(); ++i)
        others_[i][vertex] = around_of(mesh.others[i].points[vertex], mesh.others[i].facets, ring);
    const VertexNeighbors::FanKind fan = neighbors.find_fan(mesh, ring, vertex);
    const bool closed = fan == VertexNeighbors::FanKind::Closed;
    const double least = kLeastSquare * typical_square_;
    const bool parted = mesh.on_border(ring);
    const bool plain = mesh.slots.empty() && mesh.wedges.empty() && mesh.colors.empty() && !parted;
    if (closed && plain) {
        kinds_[vertex] = neighbors.order(ring) ? VertexKind::FreeFan : VertexKind::Free;
        return;
    }
    if (fan == VertexNeighbors::FanKind::Open && plain && others_.empty() &&
        neighbors.order(ring)) {
        geometry::Quadric quadric;
        const auto border = [&](uint32_t neighbor, uint32_t triangle) {
            if (neighbor > vertex && borders != nullptr)
                borders->borders.emplace_back(vertex, neighbor);
            hold_edge(quadric, mesh.points[neighbor] - mesh.points[vertex],
                      glm::dvec3(mesh.facets[triangle]), kOpen * options.boundary_weight, least);
        };
        border(neighbors.first_corner(), ring.front());
        border(neighbors.last_corner(), ring.back());
        add(own_[vertex], quadric);
        kinds_[vertex] = VertexKind::CurveFan;
        return;
    }
    geometry::Quadric quadric;
    std::vector<geometry::Quadric> quadrics(others_.size());
    int open = 0;
    int between = 0;  // the edges between chunks
    bool holds = false;
    for (const VertexNeighbors::NeighborEdge& n : neighbors.find(mesh, ring, vertex, fan)) {
        const bool two = n.uses == 2;
        if (!two && n.vertex > vertex && borders != nullptr)
            borders->borders.emplace_back(vertex, n.vertex);
        open += !two;
        between += two && mesh.parted(n.t0, n.t1);
        double weight = two ? 0 : (n.uses == 1 ? kOpen : 1) * options.boundary_weight;
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
            // Taste: a smaller kink holds more shades and spends triangles on them.
            constexpr double kLeastKink = 0.1;
            const double kink = color_kink(mesh, {vertex, n.vertex, n.t0, n.t1});
            if (kink > kLeastKink)
                weight = std::max(weight, kink * options.boundary_weight);
        }
        if (two && !mesh.uvs.empty() && weight <= 0)
            weight = kTextureKink * options.seam_weight *
                     texture_kink(mesh, {vertex, n.vertex, n.t0, n.t1});
        if (weight > 0) {
            holds = true;
            const auto hold = [&](const std::vector<glm::dvec3>& points,
                                  const std::vector<glm::vec3>& facets, geometry::Quadric& held) {
                const glm::dvec3 edge = points[n.vertex] - points[vertex];
                hold_edge(held, edge, glm::dvec3(facets[n.t0]), weight, least);
                if (n.t1 != kNone)
                    hold_edge(held, edge, glm::dvec3(facets[n.t1]), weight, least);
            };
            hold(mesh.points, mesh.facets, quadric);
            for (size_t i = 0; i < others_.size(); ++i)
                hold(mesh.others[i].points, mesh.others[i].facets, quadrics[i]);
        }
    }
    if (holds) {
        add(own_[vertex], quadric);
        for (size_t i = 0; i < others_.size(); ++i)
            add(others_[i][vertex], quadrics[i]);
    }
    kinds_[vertex] = open == 0   ? VertexKind::Free
                     : open == 2 ? VertexKind::Curve
                                 : VertexKind::Fixed;
    if (parted) {
        // Sheets that touch are told apart by their triangles alone, which levels have not in
        // common.
        const bool alone =
            !std::binary_search(mesh.shared.begin(), mesh.shared.end(), mesh.ids[vertex]);
        kinds_[vertex] =
            open == 0 && between == 2 && alone ? VertexKind::ChunkCurve : VertexKind::Fixed;
        return;
    }
    if (closed && neighbors.order(ring))
        kinds_[vertex] = VertexKind::FreeFan;
}

void EdgeQueue::build(const CollapseMesh& mesh, Adjacency& adjacency,
                      const SimplifyOptions& options, bool borders, const Job& job) {
    const size_t vertices = mesh.points.size();
    own_.resize(vertices);
    others_.resize(mesh.others.size());
    for (std::vector<VertexAround>& other : others_)
        other.resize(vertices);
    kinds_.resize(vertices);
    typical_square_ = typical_square(mesh);
    chunks_.resize((vertices + kChunk - 1) / kChunk);
    parallel_for(chunks_.size(), [&](size_t i) {
        job.check();
        EdgeChunk& chunk = chunks_[i];
        chunk.first = static_cast<uint32_t>(i * kChunk);
        chunk.last = static_cast<uint32_t>(std::min(vertices, (i + 1) * kChunk));
        chunk.borders.clear();
        VertexNeighbors neighbors;
        for (uint32_t v = chunk.first; v < chunk.last; ++v)
            visit(mesh, adjacency, options, v, neighbors, borders ? &chunk : nullptr);
    });
}

void EdgeQueue::clear() {
    chunks_ = {};
    own_ = {};
    others_ = {};
    kinds_ = {};
}

/// Computes the costs of edges, a block of them at a time.
class EdgeQueue::EdgePricing {
public:
    EdgePricing(const EdgeQueue& edges, const CollapseMesh& mesh, const Adjacency& adjacency,
                CollapseEffort effort)
        : edges_(edges), mesh_(mesh), adjacency_(adjacency), effort_(effort) {}

    /// Calls take(candidate) for every edge of which `vertex` is the lower end and that may be
    /// collapsed, at the latest in flush().
    template <typename Take>
    void price(uint32_t vertex, const Take& take) {
        const std::span<const uint32_t> ring = adjacency_.around(vertex);
        for (const uint32_t t : adjacency_.ahead(vertex))
            __builtin_prefetch(&mesh_.triangles[t]);
        if (count_ + ring.size() >= kWaiting)
            flush(take);
        const VertexKind kind = edges_.kinds_[vertex];
        const bool curve = kind == VertexKind::CurveFan;
        if ((kind != VertexKind::FreeFan && !curve) || !edges_.others_.empty()) {
            for (const VertexNeighbors::NeighborEdge& n :
                 neighbors_.find(mesh_, ring, vertex, VertexNeighbors::FanKind::None)) {
                if (n.vertex > vertex)
                    price(vertex, n.vertex, n.t0, n.uses == 2 ? n.t1 : kNone, take);
            }
            return;
        }
        // Fans have fewer triangles than there is room for edges, so all their edges find room. The
        // data for their costs are only asked for: they have come when a block of edges is full.
        uint32_t before = curve ? kNone : ring.back();
        uint32_t last = 0;
        for (const uint32_t t : ring) {
            const CornerEnds ends = ends_of(mesh_.triangles[t], vertex);
            last = ends.last;
            __builtin_prefetch(&edges_.own_[ends.next]);
            __builtin_prefetch(&mesh_.facets[t]);
            waiting_[count_] = {vertex, ends.next, t, before};
            count_ += ends.next > vertex &&
                      (!curve || edges_.allowed(vertex, ends.next, before == kNone, effort_));
            before = t;
        }
        if (curve && last > vertex && edges_.allowed(vertex, last, true, effort_))
            waiting_[count_++] = {vertex, last, ring.back(), kNone};
    }

    template <typename Take>
    void flush(const Take& take) {
        for (size_t begin = 0; begin < count_; begin += EdgeBlock::kSize) {
            const size_t count = std::min(EdgeBlock::kSize, count_ - begin);
            const PendingEdge* waiting = waiting_.data() + begin;
            for (size_t i = 0; i < count; ++i)
                block_.in[i] = input_of(waiting[i]);
            for (size_t i = count; i % 8 != 0; ++i)
                block_.in[i] = block_.in[0];
            edge_costs(block_, count);
            for (size_t i = 0; i < count; ++i)
                take(CollapseCandidate{waiting[i].a, waiting[i].b, key_of_cost(block_.cost[i]),
                                       glm::vec3(block_.x[i], block_.y[i], block_.z[i])});
        }
        count_ = 0;
    }

private:
    // Taste: more displace what is still needed; with fewer, memory comes too late.
    static constexpr size_t kWaiting = 2 * EdgeBlock::kSize;
    struct PendingEdge {
        uint32_t a, b, t0, t1;
    };
    /// `t1`: kNone where the edge is not shared by exactly two triangles.
    template <typename Take>
    void price(uint32_t a, uint32_t b, uint32_t t0, uint32_t t1, const Take& take) {
        if (!edges_.allowed(a, b, t1 == kNone || mesh_.parted(t0, t1), effort_))
            return;
        if (edges_.others_.empty()) {
            if (count_ == kWaiting)
                flush(take);
            waiting_[count_++] = {a, b, t0, t1};
            return;
        }
        const uint32_t shared[2] = {t0, t1};
        const std::span<const uint32_t> on(shared, t1 == kNone ? 1 : 2);
        const geometry::CollapseOptimum best = edges_.optimum(mesh_, a, b, on, effort_);
        take(CollapseCandidate{a, b, key_of_cost(static_cast<float>(best.cost)),
                               glm::vec3(best.point - mesh_.points[a])});
    }

    EdgeInput input_of(const PendingEdge& edge) const {
        glm::vec3 shared = mesh_.facets[edge.t0];
        if (edge.t1 != kNone)
            shared += mesh_.facets[edge.t1];
        return {&edges_.own_[edge.a], &edges_.own_[edge.b], shared,
                static_cast<float>(edges_.held(edge.a, edge.b, effort_))};
    }

    const EdgeQueue& edges_;
    const CollapseMesh& mesh_;
    const Adjacency& adjacency_;
    CollapseEffort effort_;
    VertexNeighbors neighbors_;
    EdgeBlock block_{};
    std::array<PendingEdge, kWaiting + 1> waiting_;
    size_t count_ = 0;
};

uint32_t EdgeQueue::key_of(const CollapseMesh& mesh, const Adjacency& adjacency,
                           CollapseEffort effort, size_t count) const {
    const auto vertices = static_cast<uint32_t>(mesh.points.size());
    const uint32_t step = std::max(vertices / kSampled, 1u) * kRun;
    std::vector<uint32_t> keys;
    keys.reserve(size_t{kSampled} * 4);
    const auto take = [&](const CollapseCandidate& candidate) {
        if (candidate.key < kImpossible)
            keys.push_back(candidate.key);
    };
    EdgePricing pricing(*this, mesh, adjacency, effort);
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

void EdgeQueue::take(const CollapseMesh& mesh, const Adjacency& adjacency, CollapseEffort effort,
                     uint32_t limit, double held, const Job& job) {
    parallel_for(chunks_.size(), [&](size_t i) {
        job.check();
        EdgeChunk& chunk = chunks_[i];
        const uint32_t vertices = chunk.last - chunk.first;
        const auto most = static_cast<size_t>(held * vertices);
        std::vector<CollapseCandidate> taken(vertices + 1);
        size_t count = 0;
        const auto take = [&](const CollapseCandidate& candidate) {
            taken[count] = candidate;
            count += candidate.key <= limit;
            if (count == taken.size())
                taken.resize(2 * count);
        };
        EdgePricing pricing(*this, mesh, adjacency, effort);
        for (uint32_t v = chunk.first; v < chunk.last; ++v)
            pricing.price(v, take);
        pricing.flush(take);
        taken.resize(count);
        std::vector<uint32_t> starts(kSteps + 1, 0);
        for (const CollapseCandidate& candidate : taken)
            ++starts[(candidate.key >> kKeyShift) + 1];
        for (size_t k = 0; k < kSteps; ++k)
            starts[k + 1] += starts[k];
        chunk.candidates.resize(std::min(count, most));
        for (const CollapseCandidate& candidate : taken) {
            const uint32_t at = starts[candidate.key >> kKeyShift]++;
            if (at < most)
                chunk.candidates[at] = candidate;
        }
    });
}

int EdgeQueue::cheaper_end(uint32_t a, uint32_t b) const {
    const VertexAround& at_a = own_[a];
    const VertexAround& at_b = own_[b];
    const glm::vec3 d = at_b.point - at_a.point;
    const auto cost = [&](const VertexAround& q) {
        return d.x * (q.xx * d.x + 2 * q.xy * d.y + 2 * q.xz * d.z) +
               d.y * (q.yy * d.y + 2 * q.yz * d.z) + d.z * q.zz * d.z;
    };
    return cost(at_b) < cost(at_a) ? -1 : 1;
}

bool EdgeQueue::allowed(uint32_t a, uint32_t b, bool border, CollapseEffort effort) const {
    if (effort >= CollapseEffort::Topology)
        return true;
    if (kinds_[a] == VertexKind::Fixed && kinds_[b] == VertexKind::Fixed)
        return false;
    // An inner edge between two border points is not allowed: collapsing it would pinch the
    // surface.
    return border || kinds_[a] <= VertexKind::Free || kinds_[b] <= VertexKind::Free;
}

geometry::CollapseOptimum EdgeQueue::optimum_in(const std::vector<glm::dvec3>& points,
                                                const std::vector<glm::vec3>& facets,
                                                const std::vector<VertexAround>& around, uint32_t a,
                                                uint32_t b, std::span<const uint32_t> shared,
                                                CollapseEffort effort) const {
    const geometry::EdgeEnd end_a{points[a], quadric_of(around[a]), glm::dvec3(around[a].facet)};
    const geometry::EdgeEnd end_b{points[b], quadric_of(around[b]), glm::dvec3(around[b].facet)};
    if (const int end = held(a, b, effort); end != 0) {
        const glm::dvec3& point = end < 0 ? end_a.point : end_b.point;
        return {point, geometry::collapse_cost(end_a, end_b, point)};
    }
    glm::dvec3 both(0.0);
    for (const uint32_t t : shared)
        both += glm::dvec3(facets[t]);
    return optimal_collapse(end_a, end_b, both);
}

geometry::CollapseOptimum EdgeQueue::optimum(const CollapseMesh& mesh, uint32_t a, uint32_t b,
                                             std::span<const uint32_t> shared,
                                             CollapseEffort effort) const {
    geometry::CollapseOptimum best =
        optimum_in(mesh.points, mesh.facets, own_, a, b, shared, effort);
    for (size_t i = 0; i < others_.size(); ++i) {
        const OtherPose& pose = mesh.others[i];
        best.cost += optimum_in(pose.points, pose.facets, others_[i], a, b, shared, effort).cost;
    }
    return best;
}

void EdgeQueue::other_points(const CollapseMesh& mesh, uint32_t a, uint32_t b,
                             std::span<const uint32_t> shared, CollapseEffort effort,
                             std::vector<glm::dvec3>& points) const {
    points.clear();
    for (size_t i = 0; i < others_.size(); ++i) {
        const OtherPose& pose = mesh.others[i];
        points.push_back(
            optimum_in(pose.points, pose.facets, others_[i], a, b, shared, effort).point);
    }
}

}  // namespace lodestone::simplify
