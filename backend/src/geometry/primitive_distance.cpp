// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/primitive_distance.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace lodestone {
namespace {

/// The point along the primitive's axes from its center, mirrored so that no coordinate is
/// negative.
glm::dvec3 mirrored(const Primitive& primitive, const glm::dvec3& point) {
    return glm::abs((point - primitive.center) * primitive.axes);
}

}  // namespace

double distance_to_box(const Primitive& box, const glm::dvec3& point) {
    const glm::dvec3 out = mirrored(box, point) - box.half_size;
    const double farthest = largest(out);
    return farthest > 0 ? glm::length(glm::max(out, 0.0)) : -farthest;
}

double distance_to_ellipsoid(const Primitive& ellipsoid, const glm::dvec3& point) {
    // The least distance from the planes of symmetry, over the largest half size: large enough that
    // there is one nearest point, and small enough not to matter. Flatter primitives get this
    // thickness.
    // Law: rounding of double precision, with a large margin.
    constexpr double kAside = 1e-12;
    // How much the sum may be above 1 on the ellipsoid.
    // Law: rounding of double precision, with a large margin.
    constexpr double kOn = 1e-10;
    // The most of Newton's steps.
    // Taste: a few are enough; the limit bounds the time.
    constexpr int kMostSteps = 32;
    const glm::dvec3 from_center = mirrored(ellipsoid, point);
    const double size = largest(ellipsoid.half_size);
    if (!(size > 0))
        return glm::length(from_center);
    const glm::dvec3 half = glm::max(ellipsoid.half_size / size, kAside);
    const glm::dvec3 p = glm::max(from_center / size, kAside);
    const double least = std::min({half.x, half.y, half.z});
    const glm::dvec3 more = (half - least) * (half + least);
    // With s = t + least^2 the root of the sum of (half p / (s + more))^2 is 1; one over it rises
    // and is concave. So Newton's steps that begin where the largest of the three is 1 never go too
    // far.
    const glm::dvec3 arm = half * p;
    double s = largest(arm - more);
    glm::dvec3 inverse(0.0);
    for (int step = 0; step < kMostSteps; ++step) {
        inverse = 1.0 / (s + more);
        const glm::dvec3 square = arm * inverse * arm * inverse;
        const double sum = square.x + square.y + square.z;
        if (!(sum > 1 + kOn))
            break;
        s += sum * (std::sqrt(sum) - 1) / glm::dot(square, inverse);
    }
    return size * std::abs(s - least * least) * glm::length(p * inverse);
}

}  // namespace lodestone
