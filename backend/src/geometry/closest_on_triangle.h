// SPDX-License-Identifier: GPL-3.0-or-later
// Closest on triangle: the place of a triangle that is closest to a point: exactly, one at a time,
// and in single precision for the many places that fitting asks for.
#pragma once

#include "base/maths.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <span>

namespace lodestone::geometry {

/// The point of a triangle that is closest to another: (1-u-v) a + u b + v c.
struct OnTriangle {
    glm::dvec3 point{0.0};
    double u = 0;
    double v = 0;
};
/// The closest point; also for a triangle without area.
OnTriangle closest_on_triangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b,
                               const glm::dvec3& c);

/// The number that says that no triangle was found.
inline constexpr uint32_t kNoTriangle = ~uint32_t{0};

using TrianglePoints = std::array<glm::vec3, 3>;

/// A place on a triangle.
struct TriangleSpot {
    float square = 1e30f;  // the squared distance
    uint32_t triangle = kNoTriangle;
    glm::vec3 weights{0.0f};
};

/// The barycentric coordinates of the point of triangle abc nearest to the origin. source: Ericson,
/// Real-Time Collision Detection, 5.1.5.
template <typename Number>
glm::vec<3, Number> nearest_weights(const glm::vec<3, Number>& a, const glm::vec<3, Number>& b,
                                    const glm::vec<3, Number>& c) {
    const glm::vec<3, Number> ab = b - a;
    const glm::vec<3, Number> ac = c - a;
    const Number d1 = -glm::dot(ab, a);
    const Number d2 = -glm::dot(ac, a);
    if (d1 <= 0 && d2 <= 0)
        return {1, 0, 0};
    const Number d3 = -glm::dot(ab, b);
    const Number d4 = -glm::dot(ac, b);
    if (d3 >= 0 && d4 <= d3)
        return {0, 1, 0};
    const Number vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        const Number t = d1 / (d1 - d3);
        return {1 - t, t, 0};
    }
    const Number d5 = -glm::dot(ab, c);
    const Number d6 = -glm::dot(ac, c);
    if (d6 >= 0 && d5 <= d6)
        return {0, 0, 1};
    const Number vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        const Number t = d2 / (d2 - d6);
        return {1 - t, 0, t};
    }
    const Number va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const Number t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {0, 1 - t, t};
    }
    const Number sum = va + vb + vc;
    return {va / sum, vb / sum, vc / sum};
}

/// The place of a triangle nearest to a point.
TriangleSpot nearest_spot(const TrianglePoints& corners, const glm::vec3& point);

/// The places of four triangles nearest to a point: the same bits as nearest_spot().
struct FourSpots {
    /// Law: four floats are a vector of 16 bytes, which every x86-64 processor has.
    static constexpr size_t kSize = 4;
    std::array<float, kSize> squares;
    std::array<std::array<float, kSize>, 3> weights;  // by corner
};
void four_nearest_spots(const std::array<TrianglePoints, FourSpots::kSize>& triangles,
                        const glm::vec3& point, FourSpots& spots);

/// The nearest place of several triangles, the first of those that are equally near, if it is
/// nearer than `best`. `corners(t)`: the corners of triangle t.
template <typename Corners>
void nearest_of_triangles(std::span<const uint32_t> triangles, const glm::vec3& point,
                          const Corners& corners, TriangleSpot& best) {
    constexpr size_t kSize = FourSpots::kSize;
    for (size_t first = 0; first < triangles.size(); first += kSize) {
        const size_t count = std::min(kSize, triangles.size() - first);
        std::array<TrianglePoints, kSize> four;
        for (size_t i = 0; i < kSize; ++i)
            four[i] = corners(triangles[first + std::min(i, count - 1)]);
        FourSpots spots;
        four_nearest_spots(four, point, spots);
        for (size_t i = 0; i < count; ++i) {
            if (spots.squares[i] < best.square)
                best = {spots.squares[i],
                        triangles[first + i],
                        {spots.weights[0][i], spots.weights[1][i], spots.weights[2][i]}};
        }
    }
}

}  // namespace lodestone::geometry
