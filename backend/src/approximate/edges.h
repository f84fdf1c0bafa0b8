// SPDX-License-Identifier: GPL-3.0-or-later
// Edges: all edges of a mesh with their kind, the quadrics of its vertices, and what each costs.
#pragma once

#include "approximate/adjacency.h"
#include "approximate/quadric.h"
#include "approximate/simplify.h"

namespace lodestone::approximate {

/// How far a vertex may move. Curve: inside an open border or a non-manifold edge chain.
enum class VertexKind : uint8_t { Free, Curve, Fixed };

struct Edge {
    uint32_t a, b;    // a < b
    uint32_t t0, t1;  // triangles on it; t1 == kNone: not shared by exactly two
    bool border() const { return t1 == kNone; }
};

/// What may be done to reach the target; each step includes those before.
enum class Effort : uint8_t {
    Careful,   // cheap collapses only
    Costly,    // whatever they cost
    Rough,     // triangles may turn up to 90 degrees, seams may be joined
    Topology,  // holes and tunnels may close, sheets may touch
    Anything,  // triangles may turn over; hubs of any size are collapsed
};

/// Rebuilt from the present mesh before every pass ("memoryless"); arrays are reused.
class Edges {
public:
    void build(const CollapseMesh& mesh, const Adjacency& adjacency, const SimplifyOptions& options,
               const Job& job);

    size_t size() const { return edges_.size(); }
    const Edge& operator[](size_t i) const { return edges_[i]; }
    VertexKind kind(uint32_t vertex) const { return kinds_[vertex]; }

    /// False when the kinds of its ends forbid it.
    bool allowed(const Edge& edge, Effort effort) const;
    /// Where it goes; the cost is that of all poses together.
    Optimum optimum(const CollapseMesh& mesh, const Edge& edge, Effort effort) const;
    /// Where it goes in each of the mesh's other poses.
    void other_points(const CollapseMesh& mesh, const Edge& edge, Effort effort,
                      std::vector<glm::dvec3>& points) const;

private:
    /// Of a vertex's surroundings in one pose.
    struct Around {
        std::vector<Quadric> quadrics;   // by vertex
        std::vector<glm::dvec3> facets;  // likewise: their sum
        void resize(size_t vertices) {
            quadrics.assign(vertices, Quadric{});
            facets.resize(vertices);
        }
    };
    void visit(const CollapseMesh& mesh, const Adjacency& adjacency, const SimplifyOptions& options,
               uint32_t vertex);
    Optimum optimum_in(const std::vector<glm::dvec3>& points, const std::vector<glm::dvec3>& facets,
                       const Around& around, const Edge& edge, Effort effort) const;

    struct Neighbor {
        uint32_t vertex, uses, t0, t1;
        bool leaving0, leaving1;  // the triangle runs vertex -> neighbor
    };
    std::vector<Edge> edges_;
    Around own_;
    std::vector<Around> others_;  // by pose
    std::vector<VertexKind> kinds_;
    std::vector<Neighbor> neighbors_;
    Marks marks_;
};

}  // namespace lodestone::approximate
