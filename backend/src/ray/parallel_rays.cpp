// SPDX-License-Identifier: GPL-3.0-or-later
#include "ray/parallel_rays.h"

#include "base/maths.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestone::ray {
namespace {

/// Where a point is: across the rays, and along them.
struct FramePoint {
    double x, y, depth;
};

/// Twice the area of the triangle of two points and a third, as a linear function of that one. From
/// b to a it gives the same numbers with the other sign, bit for bit, so that no ray passes between
/// two neighbors.
struct EdgeFunction {
    double x, y, constant;

    EdgeFunction(const FramePoint& a, const FramePoint& b, double sign) {
        const bool swapped = b.x < a.x || (b.x == a.x && b.y < a.y);
        const FramePoint& from = swapped ? b : a;
        const FramePoint& to = swapped ? a : b;
        const double side = swapped ? -sign : sign;
        x = side * (from.y - to.y);
        y = side * (to.x - from.x);
        constant = side * ((from.x - to.x) * from.y - (from.y - to.y) * from.x);
    }
    double operator()(double at_x, double at_y) const { return x * at_x + y * at_y + constant; }

    /// Narrows a range of x to those for which it is not negative for some y of a range.
    void narrow(double low_y, double high_y, double& low, double& high) const {
        // Below this slope over that along the rows the bound is not known well.
        // Law: far above the rounding of doubles.
        constexpr double kSteep = 1e-6;
        if (std::abs(x) <= kSteep * std::abs(y))
            return;
        const double bound = -(constant + std::max(y * low_y, y * high_y)) / x;
        if (x > 0)
            low = std::max(low, bound);
        else
            high = std::min(high, bound);
    }
};

/// A triangle on the plane across the rays.
struct DrawnTriangle {
    FramePoint a, b, c;
    double area;                    // twice its area, with the sign of its turn
    double per_area;                // one over its size
    EdgeFunction of_a, of_b, of_c;  // not negative inside

    DrawnTriangle(const FramePoint& first, const FramePoint& second, const FramePoint& third)
        : a(first),
          b(second),
          c(third),
          area((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)),
          per_area(1 / std::abs(area)),
          of_a(b, c, sign()),
          of_b(c, a, sign()),
          of_c(a, b, sign()) {}

    double sign() const { return area < 0 ? -1 : 1; }
    bool visible() const { return std::isfinite(per_area); }
    bool has(double x, double y) const {
        return std::min(of_a(x, y), std::min(of_b(x, y), of_c(x, y))) >= 0;
    }
    double depth(double u, double v) const {
        return a.depth + u * (b.depth - a.depth) + v * (c.depth - a.depth);
    }
};

/// The cell of a place along an axis: the first or the last beyond its ends.
size_t cell_of(double at, size_t cells) {
    const double last = static_cast<double>(cells - 1);
    return static_cast<size_t>(static_cast<int>(at > 0 ? std::min(at, last) : 0.0));
}

}  // namespace

ParallelRays::ParallelRays(const glm::dvec3& direction, std::span<const glm::dvec3> origins)
    : right_(perpendicular(direction)),
      up_(glm::cross(right_, direction)),
      direction_(direction),
      rays_(origins.size()) {
    // Taste: more find fewer rays that a triangle does not meet, and have more cells to look into.
    constexpr double kRaysOfCell = 1;
    std::vector<glm::dvec2> places(rays_);
    low_ = glm::dvec2(kInfinity);
    high_ = glm::dvec2(-kInfinity);
    size_t finite_rays = 0;
    for (size_t i = 0; i < rays_; ++i) {
        if (finite_rays == 0 && finite(origins[i]))
            origin_ = origins[i];
        places[i] = {glm::dot(origins[i] - origin_, right_), glm::dot(origins[i] - origin_, up_)};
        if (!std::isfinite(places[i].x + places[i].y))
            continue;
        low_ = glm::min(low_, places[i]);
        high_ = glm::max(high_, places[i]);
        ++finite_rays;
    }
    if (finite_rays == 0)
        return;
    const auto along_side =
        static_cast<size_t>(std::ceil(std::sqrt(static_cast<double>(finite_rays) / kRaysOfCell)));
    columns_ = rows_ = along_side;
    for (int i = 0; i < 2; ++i) {
        const double size = high_[i] - low_[i];
        scale_[i] = size > 0 ? static_cast<double>(along_side) / size : 0;
    }
    std::vector<uint32_t> cells(rays_);
    before_.assign(rows_ * columns_ + 1, 0);
    for (size_t i = 0; i < rays_; ++i) {
        if (!std::isfinite(places[i].x + places[i].y))
            continue;
        cells[i] = static_cast<uint32_t>(row_of(places[i].y) * columns_ + column_of(places[i].x));
        ++before_[cells[i] + size_t{1}];
    }
    for (size_t cell = 0; cell + 1 < before_.size(); ++cell)
        before_[cell + 1] += before_[cell];
    std::vector<uint32_t> next(before_.begin(), before_.end() - 1);
    for (std::vector<double>* list : {&x_, &y_, &depth_})
        list->resize(finite_rays);
    number_.resize(finite_rays);
    for (size_t i = 0; i < rays_; ++i) {
        if (!std::isfinite(places[i].x + places[i].y))
            continue;
        const uint32_t to = next[cells[i]]++;
        x_[to] = places[i].x;
        y_[to] = places[i].y;
        depth_[to] = glm::dot(origins[i] - origin_, direction_);
        number_[to] = static_cast<uint32_t>(i);
    }
}

size_t ParallelRays::column_of(double x) const {
    return cell_of((x - low_.x) * scale_.x, columns_);
}

size_t ParallelRays::row_of(double y) const {
    return cell_of((y - low_.y) * scale_.y, rows_);
}

/// Calls visit(number, triangle, place) for the places in the grid's order of all rays that meet the
/// line of a triangle's plane within it.
template <typename Visit>
void ParallelRays::draw(const Mesh& mesh, const Visit& visit) const {
    // The columns from which on a row is narrowed.
    // Taste: both ways take about the same time there.
    constexpr size_t kFew = 12;
    // The doubt about where a row ends, over its cells.
    // Law: far above the rounding of doubles.
    constexpr double kDoubt = 1e-3;
    if (number_.empty())
        return;
    std::vector<FramePoint> points(mesh.positions.size());
    for (size_t i = 0; i < points.size(); ++i) {
        const glm::dvec3 at = glm::dvec3(mesh.positions[i]) - origin_;
        points[i] = {glm::dot(at, right_), glm::dot(at, up_), glm::dot(at, direction_)};
    }
    const glm::dvec2 cell(scale_.x > 0 ? 1 / scale_.x : 0, scale_.y > 0 ? 1 / scale_.y : 0);
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const Triangle& corners = mesh.triangles[t];
        const DrawnTriangle drawn(points[corners.x], points[corners.y], points[corners.z]);
        if (!drawn.visible())
            continue;
        const glm::dvec2 low(std::min({drawn.a.x, drawn.b.x, drawn.c.x}),
                             std::min({drawn.a.y, drawn.b.y, drawn.c.y}));
        const glm::dvec2 high(std::max({drawn.a.x, drawn.b.x, drawn.c.x}),
                              std::max({drawn.a.y, drawn.b.y, drawn.c.y}));
        if (high.x < low_.x || high.y < low_.y || low.x > high_.x || low.y > high_.y)
            continue;
        const size_t first = column_of(low.x);
        const size_t last = column_of(high.x);
        const size_t last_row = row_of(high.y);
        for (size_t row = row_of(low.y); row <= last_row; ++row) {
            size_t from = first;
            size_t to = last;
            if (last - first >= kFew) {
                const double low_y = low_.y + (static_cast<double>(row) - kDoubt) * cell.y;
                const double high_y = low_y + (1 + 2 * kDoubt) * cell.y;
                double low_x = low.x;
                double high_x = high.x;
                for (const EdgeFunction* side : {&drawn.of_a, &drawn.of_b, &drawn.of_c})
                    side->narrow(low_y, high_y, low_x, high_x);
                from = column_of(low_x - kDoubt * cell.x);
                to = column_of(high_x + kDoubt * cell.x);
            }
            const size_t end = before_[row * columns_ + to + 1];
            for (size_t i = before_[row * columns_ + from]; i < end; ++i) {
                if (drawn.has(x_[i], y_[i]))
                    visit(t, drawn, i);
            }
        }
    }
}

std::vector<RayHit> ParallelRays::first_hits(const Mesh& mesh) const {
    // By place in the grid's order. Embree tells hits apart by single precision: of those that are
    // equally near the lowest triangle counts, here as well.
    struct NearestHit {
        float away = std::numeric_limits<float>::infinity();
        uint32_t triangle = kNoTriangle;
        double u = 0;
        double v = 0;
    };
    std::vector<NearestHit> nearest(number_.size());
    draw(mesh, [&](uint32_t t, const DrawnTriangle& drawn, size_t i) {
        const double u = std::min(drawn.of_b(x_[i], y_[i]) * drawn.per_area, 1.0);
        const double v = std::min(drawn.of_c(x_[i], y_[i]) * drawn.per_area, 1 - u);
        const double away = drawn.depth(u, v) - depth_[i];
        if (away >= 0 && static_cast<float>(away) < nearest[i].away)
            nearest[i] = {static_cast<float>(away), t, u, v};
    });
    std::vector<RayHit> out(rays_);
    for (size_t i = 0; i < nearest.size(); ++i) {
        const NearestHit& found = nearest[i];
        if (found.triangle == kNoTriangle)
            continue;
        RayHit& hit = out[number_[i]];
        hit.hit = true;
        hit.triangle = found.triangle;
        hit.u = found.u;
        hit.v = found.v;
        hit.t = static_cast<double>(found.away);
        const Triangle& corners = mesh.triangles[hit.triangle];
        hit.point = (1 - hit.u - hit.v) * glm::dvec3(mesh.positions[corners.x]) +
                    hit.u * glm::dvec3(mesh.positions[corners.y]) +
                    hit.v * glm::dvec3(mesh.positions[corners.z]);
    }
    return out;
}

std::vector<uint8_t> ParallelRays::blocked(const Mesh& mesh) const {
    std::vector<uint8_t> out(rays_, 0);
    draw(mesh, [&](uint32_t, const DrawnTriangle& drawn, size_t i) {
        if (drawn.depth(drawn.of_b(x_[i], y_[i]) * drawn.per_area,
                        drawn.of_c(x_[i], y_[i]) * drawn.per_area) >= depth_[i])
            out[number_[i]] = 1;
    });
    return out;
}

}  // namespace lodestone::ray
