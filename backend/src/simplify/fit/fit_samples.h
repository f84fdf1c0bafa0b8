// SPDX-License-Identifier: GPL-3.0-or-later
// Fit samples: points of an original surface, and the places of its simplified mesh nearest to
// them.
#pragma once

#include "geometry/closest_on_triangle.h"
#include "simplify/collapse/adjacency.h"

#include <glm/geometric.hpp>

namespace lodestone::simplify {

/// A point of the original. It misses its nearest place on the mesh by `miss` along `toward`.
struct FitSample {
    uint32_t triangle;
    uint32_t source;   // triangle of the original; kNone: the sample is on its outline
    float weights[3];  // weights of the triangle's corners
    glm::vec3 toward;
    float miss;
    float area;
};
using FitSamples = std::vector<FitSample>;

/// A simplified mesh, with the data needed to find an original's surface on it.
class FitPlaces {
public:
    /// `mesh` must be compact and have been opened from `source`.
    FitPlaces(CollapseMesh& mesh, const Mesh& source);

    /// A vertex of the original, in the mesh's frame.
    glm::vec3 original(uint32_t vertex) const {
        return glm::vec3((glm::dvec3(source_.positions[vertex]) - mesh_.center) * per_scale_);
    }
    /// Asks for the memory that place() and original() will need.
    void prefetch_place(uint32_t vertex) const {
        __builtin_prefetch(&mesh_.merged[vertex]);
        __builtin_prefetch(&source_.positions[vertex]);
    }
    /// The vertex that a vertex of the original became; kNone when it vanished with its part.
    uint32_t place(uint32_t vertex) const { return place_of_[mesh_.merged[vertex]]; }

    /// Numbers a vertex that was added to the mesh and to points(). `original`: unless it is kNone
    /// or stands for other vertices, it is at that place from now on.
    void add(uint32_t vertex, uint32_t original);

    CollapseMesh& mesh() { return mesh_; }
    const CollapseMesh& mesh() const { return mesh_; }
    const Mesh& source() const { return source_; }
    /// The mesh's vertices in single precision; a caller that moves one changes both.
    std::vector<glm::vec3>& points() { return points_; }
    const std::vector<glm::vec3>& points() const { return points_; }

private:
    CollapseMesh& mesh_;
    const Mesh& source_;
    double per_scale_;
    std::vector<uint32_t> place_of_;  // by the vertex that vertices were merged into in the end
    std::vector<glm::vec3> points_;
};

/// The place and the index of a sample of the original's surface, with the values that a search
/// over many needs.
struct PlacedSample {
    glm::vec3 place;
    uint32_t index;
    uint32_t source;
    float miss;
    float area;
};

/// The samples of the original's surface that lie on each triangle.
class SamplesByTriangle {
public:
    SamplesByTriangle(const FitPlaces& places, const FitSamples& samples);
    std::span<const PlacedSample> on(uint32_t triangle) const {
        return {order_.data() + first_[triangle], order_.data() + first_[triangle + 1]};
    }

private:
    std::vector<uint32_t> first_;
    std::vector<PlacedSample> order_;
};

/// Replaces `samples` by two samples each of about `want` of the original's triangles, spread
/// evenly, with room for `more` after them. `nearest`, if given, keeps the triangles nearest to
/// them from one call to the next of the same mesh: a sample that is still above or below its
/// triangle is not searched for.
void sample_surface(const FitPlaces& places, const Adjacency& adjacency, size_t want, size_t more,
                    const Job& job, FitSamples& samples, std::vector<uint32_t>* nearest = nullptr);

/// Appends samples of the edges that were open borders at first, with the borders nearest to them.
void sample_outline(FitPlaces& places, const Adjacency& adjacency, const Job& job,
                    FitSamples& samples);

/// Appends a sample for each vertex of the mesh: the surface nearest to it, among the surface
/// around it that `samples` were taken from. Vertices that stick out are drawn back.
void sample_vertices(FitPlaces& places, const Adjacency& adjacency, FitSamples& samples);

/// Computes how far each vertex of the mesh has to move (into `moves`) for the least sum of squared
/// misses, by `iterations` of a damped block Jacobi; `hold`: see FitOptions. No vertex moves
/// farther than its samples miss.
void solve_fit(const CollapseMesh& mesh, const FitSamples& samples, int iterations, float hold,
               std::vector<glm::vec3>& moves);

}  // namespace lodestone::simplify
