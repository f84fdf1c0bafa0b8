// SPDX-License-Identifier: GPL-3.0-or-later
// ParallelRays: rays of one direction, which meet a mesh of few triangles triangle by triangle.
#pragma once

#include "ray/mesh_scene.h"

#include <span>
#include <vector>

namespace lodestone::ray {

/// Rays that share a direction, sorted by where they cross a plane at a right angle to it. Drawing
/// triangles onto that plane takes far less time than asking a tree ray by ray, as long as there
/// are many rays for each triangle, and needs no tree. Needs no Embree.
class ParallelRays {
public:
    /// The direction has unit length; origins are in metres in the mesh's frame, and those that are
    /// not finite hit nothing.
    ParallelRays(const glm::dvec3& direction, std::span<const glm::dvec3> origins);

    /// The first hits with t >= 0, in the order of the origins: those of MeshScene::first_hit() on
    /// a mesh without a skin, up to rounding. Neighbors that share an edge leave no gap. Triangles
    /// with a non-finite vertex, or that are seen from their edge, are never hit.
    std::vector<RayHit> first_hits(const Mesh& mesh) const;
    /// By origin, 1 where first_hits() would hit; faster.
    std::vector<uint8_t> blocked(const Mesh& mesh) const;

private:
    template <typename Visit>
    void draw(const Mesh& mesh, const Visit& visit) const;
    size_t column_of(double x) const;
    size_t row_of(double y) const;

    glm::dvec3 right_, up_, direction_;
    glm::dvec3 origin_{0.0};  // of the frame: one of the rays'
    // The grid that the rays are sorted into, row by row, over all that are finite.
    glm::dvec2 low_{0.0};
    glm::dvec2 high_{0.0};
    glm::dvec2 scale_{0.0};  // cells over metres
    size_t columns_ = 0;
    size_t rows_ = 0;
    std::vector<uint32_t> before_;  // rays in the cells before each, and in all
    // By place in the order of the grid: where the rays start, and their numbers.
    std::vector<double> x_, y_, depth_;
    std::vector<uint32_t> number_;
    size_t rays_;
};

}  // namespace lodestone::ray
