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

/// An edge that may be collapsed, and its cost as a float's bits: those of costs sort as they do.
struct Candidate {
    Edge edge;
    uint32_t key;
};

/// Rebuilt from the present mesh before every pass ("memoryless"); arrays are reused. Works on
/// several threads; the result does not depend on how many.
class Edges {
public:
    void build(const CollapseMesh& mesh, const Adjacency& adjacency, const SimplifyOptions& options,
               const Job& job);
    /// What every edge costs; of those the ends of which forbid it, infinitely much.
    void rank(const CollapseMesh& mesh, Effort effort, const Job& job);
    /// How many can be collapsed, and the cost that (about, not below) `count` of them do not
    /// exceed.
    size_t possible() const { return possible_; }
    uint32_t key_of(size_t count) const;
    /// The possible ones up to a cost.
    void take(uint32_t limit, std::vector<Candidate>& candidates) const;

    VertexKind kind(uint32_t vertex) const { return kinds_[vertex]; }
    /// Calls visit(a, b) for every edge that is not shared by exactly two triangles.
    template <typename Visit>
    void borders(const Visit& visit) const {
        for (const Chunk& chunk : chunks_) {
            for (const Edge& edge : chunk.edges) {
                if (edge.border())
                    visit(edge.a, edge.b);
            }
        }
    }

    /// Where it goes; the cost is that of all poses together.
    Optimum optimum(const CollapseMesh& mesh, const Edge& edge, Effort effort) const;
    /// Where it goes in each of the mesh's other poses.
    void other_points(const CollapseMesh& mesh, const Edge& edge, Effort effort,
                      std::vector<glm::dvec3>& points) const;

private:
    /// Of a vertex's surroundings in one pose.
    struct Around {
        glm::vec3 point;  // as the ranking sees it
        glm::vec3 facet;  // sum of the area vectors
        float xx, xy, xz, yy, yz, zz;
        Quadric quadric() const { return {xx, xy, xz, yy, yz, zz}; }
    };
    struct Neighbor {
        uint32_t vertex, uses, t0, t1;
        bool leaving0, leaving1;  // the triangle runs vertex -> neighbor
    };
    /// Vertices [first, last), and the edges of which they are the lower end.
    struct Chunk {
        std::vector<Edge> edges;
        std::vector<uint32_t> keys;
        std::vector<Neighbor> neighbors;
    };
    void visit(const CollapseMesh& mesh, const Adjacency& adjacency, const SimplifyOptions& options,
               uint32_t vertex, Chunk& chunk);
    bool allowed(const Edge& edge, Effort effort) const;
    void rank(const CollapseMesh& mesh, Effort effort, Chunk& chunk) const;
    Optimum optimum_in(const std::vector<glm::dvec3>& points, const std::vector<glm::vec3>& facets,
                       const std::vector<Around>& around, const Edge& edge, Effort effort) const;

    std::vector<Chunk> chunks_;
    std::vector<Around> own_;                  // by vertex
    std::vector<std::vector<Around>> others_;  // by pose
    std::vector<VertexKind> kinds_;
    std::vector<uint32_t> counts_;  // of possible edges by the upper half of their keys
    size_t possible_ = 0;
};

}  // namespace lodestone::approximate
