// SPDX-License-Identifier: GPL-3.0-or-later
#include "ray/closest_search.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lodestone::ray {
namespace {

/// Rounding a coordinate of the unit sphere to single precision moves it by less than this.
constexpr double kRounding = 0x1p-22;

/// Parameter in 0...1 of the point of a + s d that is closest to p.
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
    // Outside the prism over the triangle: the nearest point lies on an edge.
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

bool ClosestSearch::find_shown(uint32_t index, OnTriangle& hidden) const {
    constexpr int kCells = 8;  // a side: 64 small triangles, looked up at their middles
    constexpr int kHalvings = 6;
    const Triangle& t = triangles[index];
    const glm::dvec3 a(positions[t.x]);
    const glm::dvec3 ab = glm::dvec3(positions[t.y]) - a;
    const glm::dvec3 ac = glm::dvec3(positions[t.z]) - a;
    const auto at = [&](double u, double v) { return OnTriangle{a + u * ab + v * ac, u, v}; };
    const auto square_to = [&](const OnTriangle& there) {
        const glm::dvec3 arm = point - there.point;
        return glm::dot(arm, arm);
    };
    double best_square = std::numeric_limits<double>::infinity();
    OnTriangle best;
    for (int i = 0; i < kCells; ++i) {
        for (int j = 0; j + i < kCells; ++j) {
            for (int half = 1; half <= (i + j < kCells - 1 ? 2 : 1); ++half) {
                const OnTriangle cell = at((i + half / 3.0) / kCells, (j + half / 3.0) / kCells);
                const double cell_square = square_to(cell);
                if (cell_square < best_square && (*shows)(index, cell.u, cell.v)) {
                    best_square = cell_square;
                    best = cell;
                }
            }
        }
    }
    if (!std::isfinite(best_square))
        return false;
    // The edge of the hole lies between what is hidden and what is shown.
    glm::dvec2 out(hidden.u, hidden.v);
    glm::dvec2 in(best.u, best.v);
    for (int i = 0; i < kHalvings; ++i) {
        const glm::dvec2 middle = 0.5 * (out + in);
        ((*shows)(index, middle.x, middle.y) ? in : out) = middle;
    }
    hidden = at(in.x, in.y);
    return true;
}

bool ClosestSearch::visit(uint32_t index) {
    const Triangle& t = triangles[index];
    OnTriangle next = closest_on_triangle(point, glm::dvec3(positions[t.x]),
                                          glm::dvec3(positions[t.y]), glm::dvec3(positions[t.z]));
    const auto wins = [&](double next_square) {
        return next_square < square || (next_square == square && index < triangle);
    };
    const auto square_to = [&](const OnTriangle& there) {
        const glm::dvec3 arm = point - there.point;
        return glm::dot(arm, arm);
    };
    double next_square = square_to(next);
    if (!wins(next_square))
        return false;
    if (shows != nullptr && !(*shows)(index, next.u, next.v)) {
        if (!find_shown(index, next))
            return false;
        next_square = square_to(next);
        if (!wins(next_square))
            return false;
    }
    square = next_square;
    triangle = index;
    where = next;
    return true;
}

float ClosestSearch::reach(double distance) const {
    const double slack =
        kRounding * (1 + std::abs(point.x) + std::abs(point.y) + std::abs(point.z));
    return static_cast<float>(distance * (1 + kRounding) + slack);
}

}  // namespace lodestone::ray
