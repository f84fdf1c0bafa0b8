// SPDX-License-Identifier: GPL-3.0-or-later
// Area points: points of a surface, spread evenly over its area.
#pragma once

#include "model/mesh.h"

#include <span>
#include <vector>

namespace lodestone::simplify {

/// The points of some triangles, which must outlive it. Triangles with a non-finite corner have
/// none.
class AreaPoints {
public:
    AreaPoints(std::span<const glm::vec3> positions, std::span<const Triangle> triangles);

    /// Whether there is no area.
    bool empty() const { return sums_.empty() || !(sums_.back() > 0); }

    struct AreaPoint {
        glm::vec3 place;
        uint32_t triangle;
        glm::vec3 weights;  // those of the triangle's corners
    };
    /// The n-th of `count` points, in the order of the triangles; there must be an area. source:
    /// Roberts 2018 (the R2 sequence), one point in each of `count` equal parts of the area.
    AreaPoint at(size_t n, size_t count) const;

private:
    std::span<const glm::vec3> positions_;
    std::span<const Triangle> triangles_;
    std::vector<double> sums_;  // of areas, up to and with each triangle
};

}  // namespace lodestone::simplify
