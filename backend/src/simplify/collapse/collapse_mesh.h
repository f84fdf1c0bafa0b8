// SPDX-License-Identifier: GPL-3.0-or-later
// Collapse mesh: the mesh of the collapse engine, with welded vertices and with attributes on
// corners ("wedges").
#pragma once

#include "base/job.h"
#include "model/mesh.h"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace lodestone::simplify {

/// The vertex, triangle or edge that does not exist.
inline constexpr uint32_t kNone = ~uint32_t{0};

/// The positions of the same vertices in another frame of an animation, with an origin of their
/// own.
struct OtherPose {
    std::vector<glm::dvec3> points;  // recentred, and scaled by the same factor as the mesh
    std::vector<glm::vec3> facets;
};

/// A mesh in which vertices at one position are one vertex, except where sheets only touch in a
/// point or coincide (these are split, so that every sheet can be simplified by itself).
struct CollapseMesh {
    std::vector<glm::dvec3> points;   // recentred and scaled into the cube of +-1
    std::vector<uint32_t> parts;      // the connected part of each vertex
    std::vector<Triangle> triangles;  // x == kNone: a dead triangle
    std::vector<glm::vec3> facets;    // the area vector (half the cross product) of each triangle
    /// The wedge of each corner; empty when no attribute is carried.
    std::vector<Triangle> wedges;
    std::vector<uint16_t> slots;  // empty, or one for each triangle
    /// Empty, or the chunk of a large surface that each triangle lies in. Vertices on borders of
    /// chunks are never moved, and only collapse along borders.
    std::vector<uint16_t> chunks;
    /// The first numbers of all vertices that share their position with another one, rising.
    std::vector<uint32_t> shared;
    std::vector<glm::vec3> normals;  // empty, or one for each wedge
    std::vector<glm::vec2> uvs;      // empty, or one for each wedge
    std::vector<glm::vec4> colors;   // empty, or one for each wedge
    std::vector<OtherPose> others;   // poses that a collapse must suit as well; mostly none
    std::vector<uint32_t> ids;       // the first number of each vertex, an index of the next two
    std::vector<uint32_t> sources;   // the (welded) input vertex that it was; kNone: inserted
    /// The vertex it was collapsed into, by first number, or itself.
    std::vector<uint32_t> merged;
    /// The edges on borders at first, by first number.
    std::vector<std::pair<uint32_t, uint32_t>> outline;
    uint32_t part_count = 0;
    size_t live = 0;  // the number of triangles that are not dead
    glm::dvec3 center{0.0};
    double scale = 1;           // a power of two: metres per unit
    bool flat_normals = false;  // every face has its own normal: made anew at the end
    bool has_normals = false;

    bool dead(size_t triangle) const { return triangles[triangle].x == kNone; }
    glm::dvec3 facet_of(const Triangle& t) const { return facet_of(points, t); }
    /// Whether a border of chunks runs between two triangles.
    bool parted(uint32_t t0, uint32_t t1) const {
        return !chunks.empty() && chunks[t0] != chunks[t1];
    }
    /// Whether triangles around a vertex lie in several chunks.
    bool on_border(std::span<const uint32_t> ring) const {
        return !chunks.empty() && std::any_of(ring.begin(), ring.end(), [&](uint32_t t) {
            return chunks[t] != chunks[ring.front()];
        });
    }
    static glm::dvec3 facet_of(const std::vector<glm::dvec3>& points, const Triangle& t) {
        return 0.5 * glm::cross(points[t.y] - points[t.x], points[t.z] - points[t.x]);
    }
    /// Appends a vertex at the position of another one; returns its index. Only before there are
    /// ids.
    uint32_t copy_vertex(uint32_t vertex) {
        points.push_back(glm::dvec3(points[vertex]));
        for (OtherPose& other : others)
            other.points.push_back(glm::dvec3(other.points[vertex]));
        sources.push_back(uint32_t{sources[vertex]});
        return static_cast<uint32_t>(points.size() - 1);
    }
};

/// The positions of the input's vertices in other frames; each has as many, and all are finite.
using OtherPositions = std::span<const std::vector<glm::vec3>>;

struct Adjacency;

/// Opens a mesh. Leaves out triangles with non-finite vertices and those with two corners at one
/// position. The result is compact; fills `adjacency`, when given. `chunks`: empty, or the chunk of
/// each triangle.
CollapseMesh open_collapse_mesh(const Mesh& mesh, const Job& job, OtherPositions others = {},
                                Adjacency* adjacency = nullptr,
                                std::span<const uint16_t> chunks = {});

/// Removes dead triangles and unused vertices, keeping the order. Fills `adjacency`, when given,
/// which takes less time than building it afterwards.
void compact(CollapseMesh& mesh, Adjacency* adjacency = nullptr);

/// Gives back the memory of dead triangles and unused vertices that were removed.
void shrink(CollapseMesh& mesh);

/// The mesh in metres again; vertices are split only where attributes differ. `vertices`, when
/// given, gets the vertex of `mesh` for each vertex of the result. `corner_normals`: empty, or
/// three for each triangle, each shown instead of the wedge's normal unless it is zero.
Mesh extract(const CollapseMesh& mesh, std::vector<uint32_t>* vertices = nullptr,
             std::span<const glm::vec3> corner_normals = {});

}  // namespace lodestone::simplify
