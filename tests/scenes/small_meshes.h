// SPDX-License-Identifier: GPL-3.0-or-later
// Small meshes with known answers, shared by the tests.
#pragma once

#include "model/primitive.h"

#include <cmath>

namespace lodestone::shapes {

/// Axis-aligned box with its lowest corner at `low`; closed, 12 triangles.
inline Mesh box(const glm::dvec3& low, const glm::dvec3& high) {
    return tessellate_box({0.5 * (low + high), glm::dmat3(1.0), 0.5 * (high - low)});
}

inline Mesh cube() {
    return box(glm::dvec3(-0.5), glm::dvec3(0.5));
}

/// width x height in the xy plane, facing +z; open, 2 triangles.
inline Mesh quad(float width, float height) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {width, 0, 0}, {width, height, 0}, {0, height, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

/// Closed and smooth: a tube of radius .3 around the unit circle.
inline Mesh torus(uint32_t around, uint32_t across) {
    Mesh mesh;
    for (uint32_t i = 0; i < around; ++i) {
        for (uint32_t j = 0; j < across; ++j) {
            const float u = 6.2831853f * static_cast<float>(i) / static_cast<float>(around);
            const float v = 6.2831853f * static_cast<float>(j) / static_cast<float>(across);
            const float r = 1 + 0.3f * std::cos(v);
            mesh.positions.emplace_back(r * std::cos(u), r * std::sin(u), 0.3f * std::sin(v));
            const uint32_t a = i * across + j;
            const uint32_t b = (i + 1) % around * across + j;
            const uint32_t c = (i + 1) % around * across + (j + 1) % across;
            const uint32_t d = i * across + (j + 1) % across;
            mesh.triangles.emplace_back(a, b, c);
            mesh.triangles.emplace_back(a, c, d);
        }
    }
    return mesh;
}

inline Mesh sphere(double radius, int subdivisions = 4) {
    return tessellate_ellipsoid({glm::dvec3(0.0), glm::dmat3(1.0), glm::dvec3(radius)},
                                subdivisions);
}

inline Mesh ellipsoid(const glm::dvec3& half_size, int subdivisions = 4) {
    return tessellate_ellipsoid({glm::dvec3(0.0), glm::dmat3(1.0), half_size}, subdivisions);
}

/// n x n bumpy height field over the unit square; open, 2 n^2 triangles.
inline Mesh terrain(uint32_t n) {
    Mesh mesh;
    for (uint32_t j = 0; j <= n; ++j) {
        for (uint32_t i = 0; i <= n; ++i) {
            const float x = static_cast<float>(i) / static_cast<float>(n);
            const float y = static_cast<float>(j) / static_cast<float>(n);
            mesh.positions.emplace_back(x, y, 0.05f * std::sin(9 * x) * std::cos(7 * y));
        }
    }
    for (uint32_t j = 0; j < n; ++j) {
        for (uint32_t i = 0; i < n; ++i) {
            const uint32_t at = j * (n + 1) + i;
            mesh.triangles.emplace_back(at, at + 1, at + n + 2);
            mesh.triangles.emplace_back(at, at + n + 2, at + n + 1);
        }
    }
    return mesh;
}

/// Two triangles that share one edge with a third: non-manifold.
inline Mesh fan() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}};
    return mesh;
}

/// Parallel `pages` sheets of 1 x 1.4 m, `gap` apart, between covers: almost nothing can be seen.
inline Mesh book(int pages, float gap = 0.001f) {
    Mesh mesh;
    for (int page = 0; page < pages; ++page) {
        Affine shift;
        shift.offset = {0, 0, page * static_cast<double>(gap)};
        append(mesh, quad(1, 1.4f), shift);
    }
    return mesh;
}

}  // namespace lodestone::shapes
