// SPDX-License-Identifier: GPL-3.0-or-later
// Fit nearest: places of triangles that are nearest to a point.
#pragma once

#include "approximate/collapse_mesh.h"

#include <algorithm>
#include <array>

namespace lodestone::approximate {

using TrianglePoints = std::array<glm::vec3, 3>;

/// A place on a triangle.
struct Spot {
    float square = 1e30f;  // of the distance
    uint32_t triangle = kNone;
    glm::vec3 weights{0.0f};
};

/// Barycentric coordinates of the point of triangle abc nearest to the origin. source: Ericson,
/// Real-Time Collision Detection, 5.1.5.
glm::vec3 nearest_weights(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

/// The place of a triangle nearest to a point.
Spot nearest_on(const TrianglePoints& corners, const glm::vec3& point);

/// Places of four triangles nearest to a point: the same bits as nearest_on().
struct FourSpots {
    static constexpr size_t kSize = 4;
    std::array<float, kSize> squares;
    std::array<std::array<float, kSize>, 3> weights;  // of each corner
};
void nearest_on_four(const std::array<TrianglePoints, FourSpots::kSize>& triangles,
                     const glm::vec3& point, FourSpots& spots);

/// The nearest place of several triangles, the first of those that are equally near, if it is
/// nearer than `best`. `corners(t)` are those of triangle t.
template <typename Corners>
void look_on(std::span<const uint32_t> triangles, const glm::vec3& point, const Corners& corners,
             Spot& best) {
    constexpr size_t kSize = FourSpots::kSize;
    for (size_t first = 0; first < triangles.size(); first += kSize) {
        const size_t count = std::min(kSize, triangles.size() - first);
        std::array<TrianglePoints, kSize> four;
        for (size_t i = 0; i < kSize; ++i)
            four[i] = corners(triangles[first + std::min(i, count - 1)]);
        FourSpots spots;
        nearest_on_four(four, point, spots);
        for (size_t i = 0; i < count; ++i) {
            if (spots.squares[i] < best.square)
                best = {spots.squares[i],
                        triangles[first + i],
                        {spots.weights[0][i], spots.weights[1][i], spots.weights[2][i]}};
        }
    }
}

}  // namespace lodestone::approximate
