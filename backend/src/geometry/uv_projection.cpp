// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/uv_projection.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lodestone {
namespace {

glm::dvec2 on_box(const glm::dvec3& p, const glm::dvec3& normal) {
    const glm::dvec3 size = glm::abs(normal);
    if (size.x >= size.y && size.x >= size.z)
        return {normal.x < 0 ? 1 - p.y : p.y, p.z};
    if (size.y >= size.z)
        return {normal.y > 0 ? 1 - p.x : p.x, p.z};
    return {normal.z > 0 ? 1 - p.y : p.y, p.x};
}

/// The longitude of a point; not a number on the axis, where there is none but for rounding.
double longitude(const glm::dvec3& p) {
    // Law: rounding of single precision, with a large margin.
    constexpr double kOnAxis = 1e-5;
    if (std::hypot(p.x, p.y) < kOnAxis)
        return std::nan("");
    return (1 - std::atan2(p.x, p.y) / kPi) / 2;
}

glm::dvec2 around(UvProjection projection, const glm::dvec3& point) {
    const glm::dvec3 p = 2.0 * point - 1.0;
    if (projection == UvProjection::Tube)
        return {longitude(p), (p.z + 1) / 2};
    const double length = glm::length(p);
    if (length == 0)
        return {std::nan(""), 0};
    return {longitude(p), 1 - std::acos(std::clamp(p.z / length, -1.0, 1.0)) / kPi};
}

/// Brings longitudes to the same side of the seam; a pole takes the mean of the others.
void join(std::array<glm::dvec2, 3>& uvs) {
    double least = 2;
    double most = -1;
    for (const glm::dvec2& uv : uvs) {
        if (!std::isnan(uv.x)) {
            least = std::min(least, uv.x);
            most = std::max(most, uv.x);
        }
    }
    double sum = 0;
    int count = 0;
    for (glm::dvec2& uv : uvs) {
        if (std::isnan(uv.x))
            continue;
        if (most - least > 0.5 && uv.x < 0.5)
            uv.x += 1;
        sum += uv.x;
        ++count;
    }
    for (glm::dvec2& uv : uvs) {
        if (std::isnan(uv.x))
            uv.x = count > 0 ? sum / count : 0;
    }
}

}  // namespace

std::array<glm::dvec2, 3> project_uvs(UvProjection projection,
                                      const std::array<glm::dvec3, 3>& points,
                                      const glm::dvec3& normal) {
    std::array<glm::dvec2, 3> uvs;
    for (size_t i = 0; i < 3; ++i) {
        switch (projection) {
            case UvProjection::Flat:
                uvs[i] = glm::dvec2(points[i]);
                break;
            case UvProjection::Box:
                uvs[i] = on_box(points[i], normal);
                break;
            case UvProjection::Sphere:
            case UvProjection::Tube:
                uvs[i] = around(projection, points[i]);
                break;
        }
    }
    if (projection == UvProjection::Sphere || projection == UvProjection::Tube)
        join(uvs);
    return uvs;
}

}  // namespace lodestone
