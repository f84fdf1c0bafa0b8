// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/scene/invertible_transform.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace lodestone::povray {
namespace {

// An object that is flattened to a sheet gets this part of its stretch as thickness.
// Taste: POV-Ray loses rays below 1e-7, and takes columns below 1e-10 for a mistake that it
// corrects to 1; a larger value shows the edges of sheets.
constexpr double kSheet = 1e-5;
/// The smallest stretch of a transform that shows anything.
/// Law: POV-Ray takes columns below 1e-10 for a mistake; this is ten times that.
constexpr double kSmallestStretch = 1e-9;

}  // namespace

bool make_invertible(Affine& transform) {
    if (!transform.finite())
        return false;
    // The smallest stretch is the volume over the other two, whose product is less than half of the
    // sum of squares.
    const double squares = glm::dot(transform.linear[0], transform.linear[0]) +
                           glm::dot(transform.linear[1], transform.linear[1]) +
                           glm::dot(transform.linear[2], transform.linear[2]);
    const double volume = std::abs(glm::determinant(transform.linear));
    if (std::isfinite(volume) && squares >= 1e-9 && volume > 1e-3 * squares * std::sqrt(squares))
        return true;
    const SymmetricEigen eigen =
        eigen_symmetric(glm::transpose(transform.linear) * transform.linear);
    // The eigenvalues of the square have lost half of the digits: only its axes are used.
    const glm::dvec3 along = transform.linear * eigen.axes[0];
    const glm::dvec3 normal = glm::cross(along, transform.linear * eigen.axes[1]);
    const double length = glm::length(along);
    const double thinnest = std::max(kSheet * length, kSmallestStretch);
    if (!std::isfinite(length) || !(length >= kSmallestStretch) ||
        !(glm::length(normal) >= thinnest * length))
        return false;
    const glm::dvec3 unit = glm::normalize(normal);
    const double thickness = glm::dot(transform.linear * eigen.axes[2], unit);
    if (std::abs(thickness) < thinnest)
        transform.linear += glm::outerProduct(
            unit * (std::copysign(thinnest, thickness) - thickness), eigen.axes[2]);
    return true;
}

}  // namespace lodestone::povray
