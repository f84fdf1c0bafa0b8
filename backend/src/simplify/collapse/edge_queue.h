// SPDX-License-Identifier: GPL-3.0-or-later
// Edge queue: all edges of a mesh with their kinds and costs, and the quadrics of its vertices.
#pragma once

#include "geometry/quadric.h"
#include "simplify/collapse/adjacency.h"
#include "simplify/collapse/edge_costs.h"
#include "simplify/simplify.h"

#include <algorithm>

namespace lodestone::simplify {

class VertexNeighbors;

/// How far a vertex may move. Curve: inside an open border or a chain of non-manifold edges.
/// ChunkCurve: inside a border of two chunks; it only moves into the next vertex there. Fan: the
/// triangles around it are in order and all turned alike.
enum class VertexKind : uint8_t { FreeFan, Free, CurveFan, Curve, ChunkCurve, Fixed };

/// The means that may be used to reach the target; each includes those before it.
enum class CollapseEffort : uint8_t {
    Careful,   // cheap collapses only
    Costly,    // collapses at any cost
    Rough,     // triangles may turn up to 90 degrees, seams may be joined
    Topology,  // holes and tunnels may close, sheets may touch
    Anything,  // triangles may turn over; hubs of any size are collapsed
};

/// An edge that may be collapsed, the bits of its cost as a float (which sort as costs do), and its
/// new position, relative to a.
struct CollapseCandidate {
    uint32_t a, b;  // a < b
    uint32_t key;
    glm::vec3 offset;
};

/// The vertices [first, last) of the mesh, the candidates of which they are the lower ends, and the
/// data by which a thread can judge these alone.
struct EdgeChunk {
    uint32_t first = 0;
    uint32_t last = 0;
    std::vector<CollapseCandidate> candidates;           // by cost, roughly: see kKeyShift
    std::vector<std::pair<uint32_t, uint32_t>> borders;  // edges not shared by two triangles
    bool has(uint32_t vertex) const { return vertex - first < last - first; }
};

/// How many lower bits of a key do not count when candidates are ordered; candidates with equal
/// upper bits stay as they come, because neighbors in the mesh mostly follow each other.
/// Taste: a larger shift orders more coarsely; 21 gives steps of 1/8 to 1/4 of the cost.
inline constexpr unsigned kKeyShift = 21;

/// Rebuilt from the present mesh before every pass ("memoryless"); the memory of the arrays is used
/// again. Edges are not stored: they are enumerated when they are visited. Works on several
/// threads; the result does not depend on how many.
class EdgeQueue {
public:
    /// Computes the surroundings of every vertex; puts fans in order. `borders`: lists the borders,
    /// too.
    void build(const CollapseMesh& mesh, Adjacency& adjacency, const SimplifyOptions& options,
               bool borders, const Job& job);
    /// The cost that about `count` edges do not exceed, from a sample of edges; kImpossible when
    /// fewer edges can be collapsed.
    uint32_t key_of(const CollapseMesh& mesh, const Adjacency& adjacency, CollapseEffort effort,
                    size_t count) const;
    /// Fills the chunks' candidates with the possible ones up to a cost, the cheapest of each
    /// chunk: at most `held` for each of its vertices.
    void take(const CollapseMesh& mesh, const Adjacency& adjacency, CollapseEffort effort,
              uint32_t limit, double held, const Job& job);
    const std::vector<EdgeChunk>& chunks() const { return chunks_; }
    /// Gives its memory back.
    void clear();

    /// The new position of a collapsed edge.
    glm::dvec3 point(const CollapseMesh& mesh, const CollapseCandidate& edge,
                     CollapseEffort effort) const {
        const int end = held(edge.a, edge.b, effort);
        return end == 0 ? mesh.points[edge.a] + glm::dvec3(edge.offset)
                        : mesh.points[end < 0 ? edge.a : edge.b];
    }
    /// The new position in each of the mesh's other poses. `shared`: the triangles on the edge.
    void other_points(const CollapseMesh& mesh, uint32_t a, uint32_t b,
                      std::span<const uint32_t> shared, CollapseEffort effort,
                      std::vector<glm::dvec3>& points) const;
    /// The end of an edge that stays in its place: -1 a, 1 b, 0 none.
    int held(uint32_t a, uint32_t b, CollapseEffort effort) const {
        const VertexKind kind_a = std::max(kinds_[a], VertexKind::Curve);
        const VertexKind kind_b = std::max(kinds_[b], VertexKind::Curve);
        if (kind_a != kind_b)
            return kind_a > kind_b ? -1 : 1;
        if (kind_a == VertexKind::ChunkCurve)
            return cheaper_end(a, b);
        return kind_a == VertexKind::Curve || effort >= CollapseEffort::Topology ? 0 : -1;
    }

private:
    class EdgePricing;
    /// The end that costs less to collapse into, as held() says it.
    int cheaper_end(uint32_t a, uint32_t b) const;
    /// The best position; the cost is that of all poses together. `shared`: the triangles on the
    /// edge.
    geometry::CollapseOptimum optimum(const CollapseMesh& mesh, uint32_t a, uint32_t b,
                                      std::span<const uint32_t> shared,
                                      CollapseEffort effort) const;
    void visit(const CollapseMesh& mesh, Adjacency& adjacency, const SimplifyOptions& options,
               uint32_t vertex, VertexNeighbors& neighbors, EdgeChunk* borders);
    bool allowed(uint32_t a, uint32_t b, bool border, CollapseEffort effort) const;
    geometry::CollapseOptimum optimum_in(const std::vector<glm::dvec3>& points,
                                         const std::vector<glm::vec3>& facets,
                                         const std::vector<VertexAround>& around, uint32_t a,
                                         uint32_t b, std::span<const uint32_t> shared,
                                         CollapseEffort effort) const;

    std::vector<EdgeChunk> chunks_;
    std::vector<VertexAround> own_;                  // by vertex; points as the ranking sees them
    std::vector<std::vector<VertexAround>> others_;  // by pose
    std::vector<VertexKind> kinds_;
    double typical_square_ = 0;  // the typical square of an edge's length
};

}  // namespace lodestone::simplify
