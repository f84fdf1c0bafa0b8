// SPDX-License-Identifier: GPL-3.0-or-later
#include "cards/card_normals.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace lodestone::cards {
namespace {

/// The shading normal at a corner of one side of a card (of that unit normal), by the mean of those
/// that it shows there.
glm::dvec3 shading_normal(const glm::dvec3& mean, const glm::dvec3& face) {
    // The cosine of the angle to the card's own normal: nearly 15 degrees.
    // Law: povray_export/mesh/leaf_normals has no leaf bent farther, for POV-Ray turns normals to
    // whoever looks, and would light one side as the other.
    constexpr double kLeastCosine = 0.966;
    const double size = glm::length(mean);
    const double along = glm::dot(mean, face);
    const glm::dvec3 across = mean - along * face;
    const double wide = glm::length(across);
    if (!(size > 0) || !(wide > 0) || !std::isfinite(size))
        return face;
    if (along >= kLeastCosine * size)
        return mean / size;
    return kLeastCosine * face + std::sqrt(1 - kLeastCosine * kLeastCosine) / wide * across;
}

}  // namespace

SideNormals::SideNormals(const SeenNormals& seen, const glm::dvec3& face) {
    for (size_t i = 0; i < corners_.size(); ++i) {
        const glm::dvec2 corner(i % 2 == 0 ? -1 : 1, i < 2 ? -1 : 1);
        corners_[i] = shading_normal(seen.at(corner), face);
    }
}

glm::dvec3 SideNormals::at(const glm::dvec2& place) const {
    const double x = 0.5 * (1 + place.x);
    const double y = 0.5 * (1 + place.y);
    return glm::normalize((1 - y) * ((1 - x) * corners_[0] + x * corners_[1]) +
                          y * ((1 - x) * corners_[2] + x * corners_[3]));
}

}  // namespace lodestone::cards
