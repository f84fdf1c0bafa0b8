// SPDX-License-Identifier: GPL-3.0-or-later
#include "approximate/edges.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include <algorithm>
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

/// The planes of the triangles around a vertex, and the sum of their area vectors.
void add_planes(const std::vector<glm::dvec3>& facets, std::span<const uint32_t> around,
                Quadric& quadric, glm::dvec3& out_sum) {
    glm::dvec3 sum(0.0);
    for (const uint32_t t : around) {
        const glm::dvec3& facet = facets[t];
        sum += facet;
        const double area = glm::length(facet);
        if (area > 1e-150)
            quadric.add(facet, 1 / area);
    }
    out_sum = sum;
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

}  // namespace

void Edges::visit(const CollapseMesh& mesh, const Adjacency& adjacency,
                  const SimplifyOptions& options, uint32_t vertex) {
    neighbors_.clear();
    marks_.clear();
    add_planes(mesh.facets, adjacency.around(vertex), own_.quadrics[vertex], own_.facets[vertex]);
    for (size_t i = 0; i < others_.size(); ++i)
        add_planes(mesh.others[i].facets, adjacency.around(vertex), others_[i].quadrics[vertex],
                   others_[i].facets[vertex]);
    for (const uint32_t t : adjacency.around(vertex)) {
        const Triangle& corners = mesh.triangles[t];
        const int at = corner_of(corners, vertex);
        for (const int step : {1, 2}) {
            const uint32_t other = corners[(at + step) % 3];
            if (!marks_.has(other)) {
                marks_.set(other, static_cast<uint32_t>(neighbors_.size()));
                neighbors_.push_back({other, 1, t, kNone, step == 1, false});
                continue;
            }
            Neighbor& known = neighbors_[marks_.number(other)];
            if (++known.uses == 2) {
                known.t1 = t;
                known.leaving1 = step == 1;
            }
        }
    }
    int borders = 0;
    for (const Neighbor& n : neighbors_) {
        const bool two = n.uses == 2;
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
                                  const std::vector<glm::dvec3>& facets, Quadric& quadric) {
                const glm::dvec3 edge = points[n.vertex] - points[vertex];
                hold_edge(quadric, edge, facets[n.t0], weight);
                if (n.t1 != kNone)
                    hold_edge(quadric, edge, facets[n.t1], weight);
            };
            hold(mesh.points, mesh.facets, own_.quadrics[vertex]);
            for (size_t i = 0; i < others_.size(); ++i)
                hold(mesh.others[i].points, mesh.others[i].facets, others_[i].quadrics[vertex]);
        }
        if (n.vertex > vertex)
            edges_.push_back({vertex, n.vertex, n.t0, two ? n.t1 : kNone});
    }
    kinds_[vertex] = borders == 0   ? VertexKind::Free
                     : borders == 2 ? VertexKind::Curve
                                    : VertexKind::Fixed;
}

void Edges::build(const CollapseMesh& mesh, const Adjacency& adjacency,
                  const SimplifyOptions& options, const Job& job) {
    const size_t vertices = mesh.points.size();
    edges_.clear();
    edges_.reserve(mesh.triangles.size() * 3 / 2 + 16);
    own_.resize(vertices);
    others_.resize(mesh.others.size());
    for (Around& other : others_)
        other.resize(vertices);
    kinds_.resize(vertices);
    marks_.resize(vertices);
    for (uint32_t v = 0; v < vertices; ++v) {
        if ((v & 0xffffu) == 0)
            job.check();
        visit(mesh, adjacency, options, v);
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
                          const std::vector<glm::dvec3>& facets, const Around& around,
                          const Edge& edge, Effort effort) const {
    const EdgeEnd a{points[edge.a], around.quadrics[edge.a], around.facets[edge.a]};
    const EdgeEnd b{points[edge.b], around.quadrics[edge.b], around.facets[edge.b]};
    const bool fixed_a = kinds_[edge.a] == VertexKind::Fixed;
    const bool fixed_b = kinds_[edge.b] == VertexKind::Fixed;
    if (fixed_a != fixed_b || (fixed_a && effort < Effort::Topology)) {
        const glm::dvec3& point = fixed_a ? a.point : b.point;
        return {point, cost_at(a, b, point)};
    }
    glm::dvec3 shared = facets[edge.t0];
    if (edge.t1 != kNone)
        shared += facets[edge.t1];
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
