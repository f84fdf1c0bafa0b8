// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/fit/area_points.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace lodestone::simplify {
namespace {

// Law: the golden ratio less 1; its multiples are spread best along a line.
constexpr double kAlong = 0.6180339887498949;
// Law: 1 / g, where g^3 = g + 1; with those of kSecond its multiples are spread well over a square.
constexpr double kFirst = 0.7548776662466927;
// Law: 1 / g^2.
constexpr double kSecond = 0.5698402909980532;

/// The fraction of a multiple of an irrational number.
double fraction(size_t n, double step) {
    const double product = (static_cast<double>(n) + 0.5) * step;
    return product - std::floor(product);
}

}  // namespace

AreaPoints::AreaPoints(std::span<const glm::vec3> positions, std::span<const Triangle> triangles)
    : positions_(positions), triangles_(triangles), sums_(triangles.size()) {
    double sum = 0;
    for (size_t t = 0; t < triangles.size(); ++t) {
        const Triangle& c = triangles[t];
        const auto area = static_cast<double>(glm::length(
            glm::cross(positions[c.y] - positions[c.x], positions[c.z] - positions[c.x])));
        sum += std::isfinite(area) ? area : 0;
        sums_[t] = sum;
    }
}

AreaPoints::AreaPoint AreaPoints::at(size_t n, size_t count) const {
    const double place =
        (static_cast<double>(n) + fraction(n, kAlong)) / static_cast<double>(count) * sums_.back();
    // The first triangle that reaches beyond the place has an area.
    auto found = std::upper_bound(sums_.begin(), sums_.end(), place);
    if (found == sums_.end())
        found = std::lower_bound(sums_.begin(), sums_.end(), sums_.back());
    const auto triangle = static_cast<uint32_t>(found - sums_.begin());
    const double root = std::sqrt(fraction(n, kFirst));
    const double along = fraction(n, kSecond);
    const glm::vec3 weights(glm::dvec3(1 - root, root * (1 - along), root * along));
    const Triangle& c = triangles_[triangle];
    return {weights.x * positions_[c.x] + weights.y * positions_[c.y] + weights.z * positions_[c.z],
            triangle, weights};
}

}  // namespace lodestone::simplify
