// SPDX-License-Identifier: GPL-3.0-or-later
// The mesh as the collapse engine sees it: welded vertices, attributes on corners ("wedges").
#pragma once

#include "base/job.h"
#include "model/mesh.h"

#include <span>
#include <utility>
#include <vector>

namespace lodestone::simplify {

inline constexpr uint32_t kNone = ~uint32_t{0};

/// The same vertices where another frame of an animation has them, in a frame of their own.
struct OtherPose {
    std::vector<glm::dvec3> points;  // recentred and scaled as much as the mesh
    std::vector<glm::vec3> facets;
};

/// Vertices at one position are one vertex, except where sheets only touch in a point or coincide
/// (those are split, so that every sheet can be simplified by itself).
struct CollapseMesh {
    std::vector<glm::dvec3> points;   // recentred and scaled into the cube of +-1
    std::vector<uint32_t> parts;      // connected part of each vertex
    std::vector<Triangle> triangles;  // x == kNone: dead
    std::vector<glm::vec3> facets;    // area vector (half the cross product) of each triangle
    std::vector<Triangle> wedges;     // wedge of each corner; empty when nothing is carried
    std::vector<uint16_t> slots;      // empty or one a triangle
    std::vector<glm::vec3> normals;   // empty or one a wedge
    std::vector<glm::vec2> uvs;       // empty or one a wedge
    std::vector<glm::vec4> colors;    // empty or one a wedge
    std::vector<OtherPose> others;    // what a collapse must suit besides; mostly none
    std::vector<uint32_t> ids;        // of each vertex: its first number, into the next two
    std::vector<uint32_t> sources;    // the input vertex (the welded one) it was; kNone: inserted
    std::vector<uint32_t> merged;  // the vertex it was collapsed into, by first number, or itself
    std::vector<std::pair<uint32_t, uint32_t>> outline;  // edges on borders at first, likewise
    uint32_t part_count = 0;
    size_t live = 0;  // triangles not dead
    glm::dvec3 center{0.0};
    double scale = 1;           // power of two: metres per unit
    bool flat_normals = false;  // every face has its own normal: made anew at the end
    bool has_normals = false;

    bool dead(size_t triangle) const { return triangles[triangle].x == kNone; }
    glm::dvec3 facet_of(const Triangle& t) const { return facet_of(points, t); }
    static glm::dvec3 facet_of(const std::vector<glm::dvec3>& points, const Triangle& t) {
        return 0.5 * glm::cross(points[t.y] - points[t.x], points[t.z] - points[t.x]);
    }
    /// Appends a vertex that is where another one is; returns its index. Before there are ids.
    uint32_t copy_vertex(uint32_t vertex) {
        points.push_back(glm::dvec3(points[vertex]));
        for (OtherPose& other : others)
            other.points.push_back(glm::dvec3(other.points[vertex]));
        sources.push_back(uint32_t{sources[vertex]});
        return static_cast<uint32_t>(points.size() - 1);
    }
};

/// Positions of the input's vertices in other frames, each as many as it has and finite.
using OtherPositions = std::span<const std::vector<glm::vec3>>;

struct Adjacency;

/// Leaves out triangles with non-finite vertices and those with two corners in one place. Compact;
/// fills `adjacency`, when given.
CollapseMesh open_collapse_mesh(const Mesh& mesh, const Job& job, OtherPositions others = {},
                                Adjacency* adjacency = nullptr);

/// Drops dead triangles and the vertices nothing uses, keeping order. Fills `adjacency`, when
/// given, which takes less time than building it afterwards.
void compact(CollapseMesh& mesh, Adjacency* adjacency = nullptr);

/// Gives back the memory that dead triangles and unused vertices took before they were dropped.
void shrink(CollapseMesh& mesh);

/// Back to metres; vertices are split only where attributes differ. `vertices`, when given, gets
/// the vertex of `mesh` that each of the result's was. `corner_normals`: empty, or three a
/// triangle, each shown in place of its wedge's unless it is zero.
Mesh extract(const CollapseMesh& mesh, std::vector<uint32_t>* vertices = nullptr,
             std::span<const glm::vec3> corner_normals = {});

}  // namespace lodestone::simplify
