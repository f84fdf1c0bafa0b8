// SPDX-License-Identifier: GPL-3.0-or-later
// Distance outliers: places where a simplified mesh and its original are far from each other.
#pragma once

#include "simplify/fit/fit_samples.h"

namespace lodestone::simplify {

/// A place of the mesh that is too far from the original, or a vertex of the original that is too
/// far from the mesh.
struct DistanceOutlier {
    float square = 0;  // the squared distance
    uint32_t triangle = kNone;
    glm::vec3 weights{0.0f};
    glm::vec3 point{0.0f};    // on the original
    uint32_t vertex = kNone;  // the original's vertex at the point; kNone: seen from the mesh
    uint32_t source = kNone;  // the triangle of the original that the point is on
};

/// Searches from the original's vertices to the mesh, and from the mesh's vertices, edges and
/// triangles to the original. Both searches only go downhill from a known place: distances are
/// never too small, but sometimes too large. The mesh may be changed between calls as long as its
/// triangles and vertices keep their numbers; `adjacency` stays that of the beginning.
class DistanceOutliers {
public:
    /// `samples`: many samples of the original's surface; others (without a source) do no harm.
    DistanceOutliers(const FitPlaces& places, const Adjacency& adjacency, const FitSamples& samples,
                     const Job& job);

    /// The worst place of each triangle, the worst first. Right only for the first `most`: places
    /// that cannot be among them are not searched for.
    std::vector<DistanceOutlier> list_farthest(size_t most, const Job& job) const;
    /// Searches from other places, too: for a vertex of the original, from where its neighbors
    /// went; for a place of the mesh, to everything that is sampled around it. False: it is not far
    /// off after all.
    bool confirm(DistanceOutlier& stray) const;
    /// The place of the original nearest to a point, downhill from one of its triangles.
    geometry::TriangleSpot walk(const glm::vec3& point, uint32_t from) const;

    geometry::TrianglePoints corners(uint32_t triangle) const {
        const Triangle& t = mesh_.triangles[triangle];
        return {points_[t.x], points_[t.y], points_[t.z]};
    }
    geometry::TrianglePoints original(uint32_t triangle) const {
        const Triangle& t = places_.source().triangles[triangle];
        return {places_.original(t.x), places_.original(t.y), places_.original(t.z)};
    }
    /// The original's vertices that are nearest to this triangle.
    std::span<const uint32_t> on(uint32_t triangle) const {
        return {order_.data() + first_[triangle], order_.data() + first_[triangle + 1]};
    }
    float square_of(uint32_t vertex) const { return nearest_[vertex].first; }

private:
    /// The most triangles around a vertex that are searched.
    /// Taste: a larger number finds more in meshes with hubs, more slowly.
    static constexpr size_t kMostRing = 32;
    std::span<const uint32_t> ring(uint32_t vertex) const {
        const std::span<const uint32_t> whole = adjacency_.around(vertex);
        return whole.first(std::min(whole.size(), kMostRing));
    }
    /// Whether the vertex was there in the beginning.
    bool known(uint32_t vertex) const { return vertex + 1 < adjacency_.first.size(); }
    /// The first of the original's vertices at that position.
    uint32_t welded(uint32_t vertex) const { return mesh_.sources[vertex]; }
    void find_rings();
    void look_from_original(const Job& job);
    geometry::TriangleSpot find(const glm::vec3& point, uint32_t from) const;
    void look(const glm::vec3& place, uint32_t triangle, const glm::vec3& weights,
              std::span<const uint32_t> hubs, float least, DistanceOutlier& worst) const;
    void confirm_from_mesh(DistanceOutlier& stray) const;
    void look_from_mesh(std::vector<DistanceOutlier>& worst, float least, const Job& job) const;

    const FitPlaces& places_;
    const CollapseMesh& mesh_;
    const Adjacency& adjacency_;
    const std::vector<glm::vec3>& points_;
    SamplesByTriangle by_triangle_;
    /// The nearest place of each of the original's vertices: squared distance, triangle.
    std::vector<std::pair<float, uint32_t>> nearest_;
    std::vector<uint32_t> first_;  // where each triangle begins in order_
    std::vector<uint32_t> order_;  // the original's vertices, by triangle
    /// Where each of the original's welded vertices begins in source_order_.
    std::vector<uint32_t> source_first_;
    std::vector<uint32_t> source_order_;  // the original's triangles, by vertex
};

}  // namespace lodestone::simplify
