// SPDX-License-Identifier: GPL-3.0-or-later
// Ridged terrain: height fields of any size, with relief of all sizes.
#pragma once

#include "base/parallel.h"
#include "model/mesh.h"

#include <algorithm>
#include <cmath>

namespace lodestone::terrains {

/// A random number in 0...1 at a point of a lattice.
inline double lattice_value(int64_t x, int64_t y, uint64_t octave) {
    const Hash hash = Hasher().value(x).value(y).value(octave).result();
    return static_cast<double>(hash >> 11u) * 0x1p-53;
}

inline double smooth_noise(double x, double y, uint64_t octave) {
    const double low_x = std::floor(x);
    const double low_y = std::floor(y);
    const auto smooth = [](double t) { return t * t * (3 - 2 * t); };
    const double u = smooth(x - low_x);
    const double v = smooth(y - low_y);
    const auto i = static_cast<int64_t>(low_x);
    const auto j = static_cast<int64_t>(low_y);
    const double front =
        (1 - u) * lattice_value(i, j, octave) + u * lattice_value(i + 1, j, octave);
    const double back =
        (1 - u) * lattice_value(i, j + 1, octave) + u * lattice_value(i + 1, j + 1, octave);
    return (1 - v) * front + v * back;
}

/// The height above a place of the unit square, in its units: ridges, and on them ever finer ones.
inline double height_at(double x, double y) {
    double height = 0;
    double amplitude = 0.06;
    double cells = 4;
    for (uint64_t octave = 0; octave < 9; ++octave, amplitude *= 0.45, cells *= 2)
        height += amplitude * (1 - std::abs(2 * smooth_noise(cells * x, cells * y, octave) - 1));
    return height;
}

/// The same east of the middle, and a plain west of it.
inline double half_plain_height_at(double x, double y) {
    const double hilly = std::min(std::max(5 * x - 2, 0.0), 1.0);
    return 0.02 * smooth_noise(4 * x, 4 * y, 9) + hilly * height_at(x, y);
}

/// A sheet of 2 * (side - 1)^2 triangles over a square of `size` metres, with normals. `height`:
/// that above a place of the unit square.
template <typename Height>
Mesh height_field(uint32_t side, double size, const Height& height) {
    Mesh mesh;
    mesh.positions.resize(size_t{side} * side);
    mesh.normals.resize(mesh.positions.size());
    const double step = 1.0 / (side - 1);
    parallel_for(side, [&](size_t row) {
        for (uint32_t column = 0; column < side; ++column) {
            const double x = column * step;
            const double y = static_cast<double>(row) * step;
            const double slope_x = (height(x + step, y) - height(x - step, y)) / (2 * step);
            const double slope_y = (height(x, y + step) - height(x, y - step)) / (2 * step);
            const size_t at = row * side + column;
            mesh.positions[at] = glm::vec3(size * glm::dvec3(x, y, height(x, y)));
            mesh.normals[at] = glm::vec3(glm::normalize(glm::dvec3(-slope_x, -slope_y, 1)));
        }
    });
    mesh.triangles.reserve(2 * size_t{side - 1} * (side - 1));
    for (uint32_t row = 0; row + 1 < side; ++row) {
        for (uint32_t column = 0; column + 1 < side; ++column) {
            const uint32_t at = row * side + column;
            mesh.triangles.emplace_back(at, at + 1, at + side + 1);
            mesh.triangles.emplace_back(at, at + side + 1, at + side);
        }
    }
    return mesh;
}

inline Mesh terrain(uint32_t side, double size = 1) {
    return height_field(side, size, height_at);
}

}  // namespace lodestone::terrains
