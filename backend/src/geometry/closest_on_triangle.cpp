// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/closest_on_triangle.h"

#include <cstring>
#include <limits>

namespace lodestone::geometry {
namespace {

using Lanes = float __attribute__((vector_size(4 * FourSpots::kSize)));

struct FourVectors {
    Lanes x, y, z;
};
FourVectors operator-(const FourVectors& a, const FourVectors& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Lanes dot(const FourVectors& a, const FourVectors& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// The parameter in 0...1 of the point of a + s d that is closest to p.
double on_segment(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& d) {
    const double square = glm::dot(d, d);
    return square > 0 ? std::clamp(glm::dot(p - a, d) / square, 0.0, 1.0) : 0.0;
}

}  // namespace

OnTriangle closest_on_triangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b,
                               const glm::dvec3& c) {
    const glm::dvec3 ab = b - a;
    const glm::dvec3 ac = c - a;
    const glm::dvec3 normal = glm::cross(ab, ac);
    const double square = glm::dot(normal, normal);
    if (square > 0) {
        const glm::dvec3 ap = p - a;
        const double u = glm::dot(glm::cross(ap, ac), normal) / square;
        const double v = glm::dot(glm::cross(ab, ap), normal) / square;
        if (u >= 0 && v >= 0 && u + v <= 1)
            return {a + u * ab + v * ac, u, v};
    }
    // Outside the prism over the triangle the nearest point lies on an edge.
    const double s_ab = on_segment(p, a, ab);
    const double s_ac = on_segment(p, a, ac);
    const double s_bc = on_segment(p, b, c - b);
    const std::array<OnTriangle, 3> edges{OnTriangle{a + s_ab * ab, s_ab, 0},
                                          OnTriangle{a + s_ac * ac, 0, s_ac},
                                          OnTriangle{b + s_bc * (c - b), 1 - s_bc, s_bc}};
    size_t best = 0;
    double best_square = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < 3; ++i) {
        const glm::dvec3 arm = p - edges[i].point;
        if (glm::dot(arm, arm) < best_square) {
            best_square = glm::dot(arm, arm);
            best = i;
        }
    }
    return edges[best];
}

TriangleSpot nearest_spot(const TrianglePoints& corners, const glm::vec3& point) {
    const glm::vec3 a = corners[0] - point;
    const glm::vec3 b = corners[1] - point;
    const glm::vec3 d = corners[2] - point;
    const glm::vec3 weights = nearest_weights(a, b, d);
    const glm::vec3 off = weights.x * a + weights.y * b + weights.z * d;
    return {glm::dot(off, off), 0, weights};
}

/// Decides as nearest_weights() does, but for all regions at once: the last one that is written is
/// the first one there.
void four_nearest_spots(const std::array<TrianglePoints, FourSpots::kSize>& triangles,
                        const glm::vec3& point, FourSpots& spots) {
    const auto corner = [&](size_t k) {
        const auto lanes = [&](int axis) {
            return Lanes{triangles[0][k][axis], triangles[1][k][axis], triangles[2][k][axis],
                         triangles[3][k][axis]} -
                   point[axis];
        };
        return FourVectors{lanes(0), lanes(1), lanes(2)};
    };
    const FourVectors a = corner(0);
    const FourVectors b = corner(1);
    const FourVectors c = corner(2);
    const FourVectors ab = b - a;
    const FourVectors ac = c - a;
    const Lanes d1 = -dot(ab, a);
    const Lanes d2 = -dot(ac, a);
    const Lanes d3 = -dot(ab, b);
    const Lanes d4 = -dot(ac, b);
    const Lanes d5 = -dot(ab, c);
    const Lanes d6 = -dot(ac, c);
    const Lanes va = d3 * d6 - d5 * d4;
    const Lanes vb = d5 * d2 - d1 * d6;
    const Lanes vc = d1 * d4 - d3 * d2;
    const Lanes sum = va + vb + vc;
    constexpr Lanes kZero{};
    const Lanes one = kZero + 1.0f;
    Lanes u = va / sum;
    Lanes v = vb / sum;
    Lanes w = vc / sum;
    const auto put = [&](const auto& here, const Lanes& x, const Lanes& y, const Lanes& z) {
        u = here ? x : u;
        v = here ? y : v;
        w = here ? z : w;
    };
    const auto on_bc = (va <= 0) & (d4 - d3 >= 0) & (d5 - d6 >= 0);
    const auto on_ac = (vb <= 0) & (d2 >= 0) & (d6 <= 0);
    const auto on_ab = (vc <= 0) & (d1 >= 0) & (d3 <= 0);
    const Lanes over = on_ab ? d1 : (on_ac ? d2 : d4 - d3);
    const Lanes under = on_ab ? d1 - d3 : (on_ac ? d2 - d6 : (d4 - d3) + (d5 - d6));
    const Lanes t = over / under;
    put(on_bc, kZero, one - t, t);
    put(on_ac, one - t, kZero, t);
    put((d6 >= 0) & (d5 <= d6), kZero, kZero, one);
    put(on_ab, one - t, t, kZero);
    put((d3 >= 0) & (d4 <= d3), kZero, one, kZero);
    put((d1 <= 0) & (d2 <= 0), one, kZero, kZero);
    const FourVectors off{u * a.x + v * b.x + w * c.x, u * a.y + v * b.y + w * c.y,
                          u * a.z + v * b.z + w * c.z};
    const Lanes squares = dot(off, off);
    std::memcpy(spots.squares.data(), &squares, sizeof(Lanes));
    std::memcpy(spots.weights[0].data(), &u, sizeof(Lanes));
    std::memcpy(spots.weights[1].data(), &v, sizeof(Lanes));
    std::memcpy(spots.weights[2].data(), &w, sizeof(Lanes));
}

}  // namespace lodestone::geometry
