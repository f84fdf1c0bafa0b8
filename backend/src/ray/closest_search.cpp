// SPDX-License-Identifier: GPL-3.0-or-later
#include "ray/closest_search.h"

#include <algorithm>
#include <cmath>

namespace lodestone::ray {
namespace {

/// The most that rounding to single precision moves a coordinate of the unit sphere, with a margin.
/// Law: IEEE 754, half a unit in the last place is 2^-25 below 1.
constexpr double kRounding = 0x1p-22;

}  // namespace

bool ClosestSearch::find_shown(uint32_t index, geometry::OnTriangle& hidden) const {
    // Cells along a side of a triangle: 64 small triangles, looked up at their middles.
    // Taste: a larger value finds smaller holes and grains, for time that grows with its square.
    constexpr int kCells = 8;
    // Halvings between a hidden and a shown point.
    // Taste: a larger value places a hole's edge better than 1/64 of their distance.
    constexpr int kHalvings = 6;
    const Triangle& t = triangles[index];
    const glm::dvec3 a(positions[t.x]);
    const glm::dvec3 ab = glm::dvec3(positions[t.y]) - a;
    const glm::dvec3 ac = glm::dvec3(positions[t.z]) - a;
    const auto at = [&](double u, double v) {
        return geometry::OnTriangle{a + u * ab + v * ac, u, v};
    };
    const auto square_to = [&](const geometry::OnTriangle& there) {
        const glm::dvec3 arm = point - there.point;
        return glm::dot(arm, arm);
    };
    double best_square = std::numeric_limits<double>::infinity();
    geometry::OnTriangle best;
    for (int i = 0; i < kCells; ++i) {
        for (int j = 0; j + i < kCells; ++j) {
            for (int half = 1; half <= (i + j < kCells - 1 ? 2 : 1); ++half) {
                const geometry::OnTriangle cell =
                    at((i + half / 3.0) / kCells, (j + half / 3.0) / kCells);
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
    // The edge of the hole lies between a hidden point and a shown one.
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
    if (facing != glm::dvec3(0.0)) {
        const glm::dvec3 a(positions[t.x]);
        const glm::dvec3 area =
            glm::cross(glm::dvec3(positions[t.y]) - a, glm::dvec3(positions[t.z]) - a);
        if (!(glm::dot(area, facing) > 0))
            return false;
    }
    geometry::OnTriangle next = geometry::closest_on_triangle(
        point, glm::dvec3(positions[t.x]), glm::dvec3(positions[t.y]), glm::dvec3(positions[t.z]));
    const auto wins = [&](double next_square) {
        return next_square < square || (next_square == square && index < triangle);
    };
    const auto square_to = [&](const geometry::OnTriangle& there) {
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
