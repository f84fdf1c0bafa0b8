// SPDX-License-Identifier: GPL-3.0-or-later
// Principal axes: the frame of a surface, settled by its normals where second moments leave it
// open.
#pragma once

#include "base/maths.h"

#include <array>

namespace lodestone::measure {

/// The fourth moment of a surface's unit normals, from which sum n_i^4 follows in any frame. The
/// second moment (4.31) cannot tell a box from a sphere; this one can: box 1, sphere 0.6.
class NormalMoments {
public:
    /// Adds a unit normal.
    void add(const glm::dvec3& normal, double weight);
    /// The mean of (normal . axis)^4 for a unit axis; 0 when nothing was added.
    double along(const glm::dvec3& axis) const;
    /// The mean of sum n_i^4 with the normals seen in a frame of orthonormal columns.
    double in_frame(const glm::dmat3& axes) const;

private:
    std::array<double, 15> sums_{};  // sums of x^i y^j z^k with i + j + k = 4
    double weight_ = 0;
};

/// The principal frame of second moments of any scale (orthonormal right-handed columns, descending
/// variance). Where variances are nearly equal the eigenvectors are noise: there the axes are
/// turned in that plane (or space) to the frame with the highest in_frame(), when that rises by
/// more than 0.05: a cube gets its own axes, a cylinder keeps its eigenvectors.
glm::dmat3 principal_axes(const glm::dmat3& moments, const NormalMoments& normals);

}  // namespace lodestone::measure
