// SPDX-License-Identifier: GPL-3.0-or-later
// Finely divided meshes whose simplest form is known, shared by the tests.
#pragma once

#include "scenes/small_meshes.h"

namespace lodestone::shapes {

/// n x n cells of a unit face with its corner at `origin`, spanned by u and v; one normal.
inline void add_face(Mesh& mesh, uint32_t n, const glm::dvec3& origin, const glm::dvec3& u,
                     const glm::dvec3& v) {
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (uint32_t j = 0; j <= n; ++j) {
        for (uint32_t i = 0; i <= n; ++i) {
            mesh.positions.emplace_back(origin + u * (double(i) / n) + v * (double(j) / n));
            mesh.normals.emplace_back(glm::normalize(glm::cross(u, v)));
        }
    }
    for (uint32_t j = 0; j < n; ++j) {
        for (uint32_t i = 0; i < n; ++i) {
            const uint32_t at = first + j * (n + 1) + i;
            mesh.triangles.emplace_back(at, at + 1, at + n + 2);
            mesh.triangles.emplace_back(at, at + n + 2, at + n + 1);
        }
    }
}

inline Mesh grid(uint32_t n) {
    Mesh mesh;
    add_face(mesh, n, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    mesh.normals.clear();
    return mesh;
}

/// The cube 0...1 with n x n cells a side and sharp edges.
inline Mesh fine_cube(uint32_t n) {
    Mesh mesh;
    const glm::dvec3 x(1, 0, 0);
    const glm::dvec3 y(0, 1, 0);
    const glm::dvec3 z(0, 0, 1);
    const glm::dvec3 o(0);
    add_face(mesh, n, o, y, x);
    add_face(mesh, n, z, x, y);
    add_face(mesh, n, o, z, y);
    add_face(mesh, n, x, y, z);
    add_face(mesh, n, o, x, z);
    add_face(mesh, n, y, z, x);
    return mesh;
}

/// Radius 1, height 2, smooth normals; u goes once around (seam at angle 0), v up; open ends.
inline Mesh seamed_cylinder(uint32_t around, uint32_t up) {
    Mesh mesh;
    for (uint32_t j = 0; j <= up; ++j) {
        for (uint32_t i = 0; i <= around; ++i) {
            const double angle = 2 * 3.14159265358979 * (i % around) / around;
            mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 2.0 * j / up);
            mesh.normals.emplace_back(std::cos(angle), std::sin(angle), 0.0);
            mesh.uvs.emplace_back(double(i) / around, double(j) / up);
        }
    }
    for (uint32_t j = 0; j < up; ++j) {
        for (uint32_t i = 0; i < around; ++i) {
            const uint32_t at = j * (around + 1) + i;
            mesh.triangles.emplace_back(at, at + 1, at + around + 2);
            mesh.triangles.emplace_back(at, at + around + 2, at + around + 1);
        }
    }
    return mesh;
}

inline Mesh moved(const Mesh& mesh, const glm::dvec3& offset) {
    Affine shift;
    shift.offset = offset;
    Mesh out;
    append(out, mesh, shift);
    return out;
}

/// `count` cubes of side 0.5 on a square lattice.
inline Mesh boxes(int count) {
    Mesh mesh;
    for (int i = 0; i < count; ++i)
        append(mesh, moved(cube(), {2 * (i % 20), 2 * (i / 20), 0}), Affine{});
    mesh.normals.clear();
    return mesh;
}

}  // namespace lodestone::shapes
