// SPDX-License-Identifier: GPL-3.0-or-later
// Edges: all edges of a mesh with their kind, the quadrics of its vertices, and what each costs.
#pragma once

#include "geometry/quadric.h"
#include "simplify/collapse/adjacency.h"
#include "simplify/collapse/edge_costs.h"
#include "simplify/simplify.h"

namespace lodestone::simplify {

class VertexNeighbors;

/// How far a vertex may move. Curve: inside an open border or a non-manifold edge chain. Fan: the
/// triangles around it are in order and all turned alike.
enum class VertexKind : uint8_t { FreeFan, Free, CurveFan, Curve, Fixed };

/// What may be done to reach the target; each step includes those before.
enum class CollapseEffort : uint8_t {
    Careful,   // cheap collapses only
    Costly,    // whatever they cost
    Rough,     // triangles may turn up to 90 degrees, seams may be joined
    Topology,  // holes and tunnels may close, sheets may touch
    Anything,  // triangles may turn over; hubs of any size are collapsed
};

/// An edge that may be collapsed, its cost as a float's bits (those of costs sort as they do), and
/// where it goes, from a.
struct CollapseCandidate {
    uint32_t a, b;  // a < b
    uint32_t key;
    glm::vec3 offset;
};

/// Vertices [first, last) of the mesh, the candidates of which they are the lower ends, and what of
/// these can be judged on a thread of its own.
struct EdgeChunk {
    uint32_t first = 0;
    uint32_t last = 0;
    std::vector<CollapseCandidate> candidates;           // by cost, roughly: see kKeyShift
    std::vector<std::pair<uint32_t, uint32_t>> borders;  // edges not shared by two triangles
    bool has(uint32_t vertex) const { return vertex - first < last - first; }
};

/// Candidates are ordered by the upper bits of their keys (steps of a quarter to an eighth), those
/// of one step as they come: neighbors in the mesh mostly follow each other.
inline constexpr unsigned kKeyShift = 21;

/// Rebuilt from the present mesh before every pass ("memoryless"); arrays are reused. Edges are not
/// stored: they are enumerated when they are looked at. Works on several threads; the result does
/// not depend on how many.
class EdgeQueue {
public:
    /// The surroundings of every vertex; puts fans in order. `borders`: lists them, too.
    void build(const CollapseMesh& mesh, Adjacency& adjacency, const SimplifyOptions& options,
               bool borders, const Job& job);
    /// The cost that about `count` edges do not exceed, from a sample of them; what nothing exceeds
    /// when not as many can be collapsed.
    uint32_t key_of(const CollapseMesh& mesh, const Adjacency& adjacency, CollapseEffort effort,
                    size_t count) const;
    /// Fills the chunks' candidates with the possible ones up to a cost, the cheapest of each
    /// chunk: not more than `held` for each of its vertices.
    void take(const CollapseMesh& mesh, const Adjacency& adjacency, CollapseEffort effort,
              uint32_t limit, double held, const Job& job);
    const std::vector<EdgeChunk>& chunks() const { return chunks_; }
    /// Gives its memory back.
    void clear();

    /// Where the edge goes.
    glm::dvec3 point(const CollapseMesh& mesh, const CollapseCandidate& edge,
                     CollapseEffort effort) const {
        const int end = held(edge.a, edge.b, effort);
        return end == 0 ? mesh.points[edge.a] + glm::dvec3(edge.offset)
                        : mesh.points[end < 0 ? edge.a : edge.b];
    }
    /// Where it goes in each of the mesh's other poses. `shared`: triangles on it.
    void other_points(const CollapseMesh& mesh, uint32_t a, uint32_t b,
                      std::span<const uint32_t> shared, CollapseEffort effort,
                      std::vector<glm::dvec3>& points) const;

private:
    class EdgePricing;
    /// The end of an edge that stays where it is: -1 a, 1 b, 0 none.
    int held(uint32_t a, uint32_t b, CollapseEffort effort) const {
        const bool fixed_a = kinds_[a] == VertexKind::Fixed;
        const bool fixed_b = kinds_[b] == VertexKind::Fixed;
        if (fixed_a == fixed_b && (!fixed_a || effort >= CollapseEffort::Topology))
            return 0;
        return fixed_a ? -1 : 1;
    }
    /// The cost is that of all poses together. `shared`: triangles on the edge.
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
    double typical_square_ = 0;  // of an edge's length
};

}  // namespace lodestone::simplify
