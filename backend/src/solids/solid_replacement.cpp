// SPDX-License-Identifier: GPL-3.0-or-later
#include "solids/solid_replacement.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace lodestone::solids {
namespace {

/// The share of the largest variance below which variances are zero.
/// Law: rounding of double precision, with a large margin.
constexpr double kFlatVariance = 1e-12;
/// The least thickness, relative to the next larger half axis.
/// Taste: a larger one is seen; without thickness two faces would be in one place.
constexpr double kThickness = 1e-3;
/// The visible area over that of the matched solid below which a group is mostly air.
/// Taste: a larger one refuses more solids.
constexpr double kSparse = 0.1;
/// A row (one axis is this many times the next) is refused earlier.
/// Taste: a smaller number treats more things as rows.
constexpr double kRow = 4;
// Law: the square of 0.6; a sparser solid, scaled to its area, would be shorter than that.
constexpr double kSparseRow = 0.36;
/// The largest matched size over the extent of the bound. Things in two heaps ask for a solid that
/// reaches beyond them: 1.44 (box) and 1.67 (ellipsoid) in the limit; a cube asks for an ellipsoid
/// of 1.29.
/// Taste: between a filled box (1) and two heaps (1.44).
constexpr double kBoxReach = 1.2;
// Taste: between a cube (1.29) and two heaps (1.67).
constexpr double kEllipsoidReach = 1.4;
/// The share of its shell that a clear solid covers: an object that covers more is better shown as
/// a solid of its area, and one that covers less is hardly there.
/// Taste: a larger share makes more solids clear, a smaller one draws air as solid.
constexpr double kClear = 0.55;
// Taste: a larger share leaves out things that are still seen.
constexpr double kFaintest = 0.02;
/// The moment of normals from which on a box shows the outline better.
/// Law: half way from a sphere (0.6) to a box (1).
constexpr double kBoxMoment = 0.8;

/// The frame in which the variances are matched.
glm::dmat3 axes_of(const Attributes& attributes) {
    return attributes.axes;
}

glm::dvec3 variances_along(const Attributes& attributes, const glm::dmat3& axes) {
    glm::dvec3 out;
    for (int i = 0; i < 3; ++i)
        out[i] = glm::dot(axes[i], attributes.moments * axes[i]) / attributes.visible_area;
    const double floor = kFlatVariance * std::max({out.x, out.y, out.z});
    return glm::max(out, glm::dvec3(floor));
}

bool usable(const Attributes& attributes) {
    double sum = attributes.visible_area;
    double trace = 0;
    for (int i = 0; i < 3; ++i) {
        sum += attributes.centroid[i];
        trace += attributes.moments[i][i];
        for (int j = 0; j < 3; ++j)
            sum += attributes.moments[i][j];
    }
    return !attributes.empty() && std::isfinite(sum) && trace > 0 &&
           std::isfinite(trace / attributes.visible_area) && trace / attributes.visible_area > 0;
}

/// The half axes of the box with the given variances: Newton on logarithms. The Jacobian's
/// determinant stays within 5.1...8.0, so steps are always defined; 4 are enough.
glm::dvec3 match_box(const glm::dvec3& variances) {
    glm::dvec3 sides = glm::sqrt(12.0 * variances);
    for (int step = 0; step < 50; ++step) {
        glm::dvec3 miss;
        glm::dmat3 slope;  // slope[column][row]
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3;
            const int k = (i + 2) % 3;
            const double ij = sides[i] * sides[j];
            const double jk = sides[j] * sides[k];
            const double ki = sides[k] * sides[i];
            const double above = ij + 3 * jk + ki;  // A.14: alpha = above / below
            const double below = ij + jk + ki;
            miss[i] = std::log(above / below * sides[i] * sides[i] / 12 / variances[i]);
            slope[i][i] = 2 + (ij + ki) / above - (ij + ki) / below;
            slope[j][i] = (ij + 3 * jk) / above - (ij + jk) / below;
            slope[k][i] = (ki + 3 * jk) / above - (ki + jk) / below;
        }
        sides *= glm::exp(-(glm::inverse(slope) * miss));
        if (std::max({std::abs(miss.x), std::abs(miss.y), std::abs(miss.z)}) < 1e-14)
            break;
    }
    return 0.5 * sides;
}

/// The half axes of an ellipsoid: each follows its own variance; the influence of the others is
/// weak, so this contracts.
glm::dvec3 match_ellipsoid(const glm::dvec3& variances) {
    // The power by which half axes follow the ratio of variances.
    // Fitted: by the steps for the ellipsoids of samples/street (0.5 takes more).
    constexpr double kFaster = 0.55;
    // The change below which the half axes stand still.
    // Taste: a smaller one takes more steps; nobody measures variances that well.
    constexpr double kSame = 1e-8;
    glm::dvec3 half = glm::sqrt(3.0 * variances);
    for (int step = 0; step < 200; ++step) {
        const glm::dvec3 ratio = variances / ellipsoid_shell(half).variances;
        half *= glm::pow(ratio, glm::dvec3(kFaster));
        if (glm::length(ratio - 1.0) < kSame)
            break;
    }
    return half;
}

double extent_along(const Bound& bound, const glm::dvec3& axis) {
    return std::min(2 * bound.radius, glm::dot(glm::abs(axis), bound.box.size()));
}

void keep_thickness(glm::dvec3& half) {
    std::array<int, 3> order{0, 1, 2};
    std::sort(order.begin(), order.end(), [&](int i, int j) { return half[i] > half[j]; });
    for (int i = 1; i < 3; ++i)
        half[order[i]] = std::max(half[order[i]], kThickness * half[order[i - 1]]);
}

/// The primitive whose variances are the object's, and the share of its area that can be seen.
struct MatchedPrimitive {
    Primitive primitive;
    double density = 0;
};

/// None where the object has no extent to match, or is in two heaps.
template <typename Match, typename Measure>
std::optional<MatchedPrimitive> matched(const Attributes& attributes, const Bound& bound,
                                        Match match, Measure measure, double reach) {
    if (!usable(attributes))
        return std::nullopt;
    MatchedPrimitive out;
    Primitive& primitive = out.primitive;
    primitive.center = attributes.centroid;
    primitive.axes = axes_of(attributes);
    primitive.half_size = match(variances_along(attributes, primitive.axes));
    out.density = attributes.visible_area / measure(primitive.half_size).area;
    const double longest =
        std::max({primitive.half_size.x, primitive.half_size.y, primitive.half_size.z});
    keep_thickness(primitive.half_size);
    for (int i = 0; i < 3; ++i) {
        const double half = primitive.half_size[i];
        if (!std::isfinite(half) || !(half > 0))
            return std::nullopt;
        // An object that is flat along an axis has no extent there to compare with.
        if (!bound.empty() && half > 2 * kThickness * longest &&
            2 * half > reach * extent_along(bound, primitive.axes[i]))
            return std::nullopt;
    }
    return out;
}

template <typename Match, typename Measure>
std::optional<Primitive> fit(const Attributes& attributes, const Bound& bound, Match match,
                             Measure measure, double reach) {
    const std::optional<MatchedPrimitive> found = matched(attributes, bound, match, measure, reach);
    if (!found)
        return std::nullopt;
    Primitive out = found->primitive;
    glm::dvec3 sorted = out.half_size;
    std::sort(&sorted[0], &sorted[0] + 3);
    const bool row = sorted[2] > kRow * sorted[1];
    if (!(found->density >= (row ? kSparseRow : kSparse)))
        return std::nullopt;
    // 4.33: scaled so that the visible area is the same; the ratios of the variances stay.
    out.half_size *= std::sqrt(attributes.visible_area / measure(out.half_size).area);
    for (int i = 0; i < 3; ++i) {
        if (!std::isfinite(out.half_size[i]) || !(out.half_size[i] > 0))
            return std::nullopt;
    }
    return out;
}

template <typename Match, typename Measure>
std::optional<ClearSolid> fit_clear(const Attributes& attributes, const Bound& bound, Match match,
                                    Measure measure, double reach) {
    const std::optional<MatchedPrimitive> found = matched(attributes, bound, match, measure, reach);
    if (!found || !(found->density >= kFaintest && found->density < kClear))
        return std::nullopt;
    return ClearSolid{found->primitive, found->density};
}

/// The 32 Gauss-Legendre nodes on 0...1.
struct GaussLegendre {
    // Taste: more nodes are more exact, more slowly; 32 hold closed forms to 1e-10.
    static constexpr int kCount = 32;
    std::array<double, kCount> at;
    std::array<double, kCount> weight;

    GaussLegendre() {
        for (int i = 0; i < kCount; ++i) {
            double x = std::cos(3.14159265358979323846 * (i + 0.75) / (kCount + 0.5));
            double slope = 1;
            for (int step = 0; step < 20; ++step) {
                double now = x;
                double before = 1;
                for (int n = 2; n <= kCount; ++n) {
                    const double next = ((2 * n - 1) * x * now - (n - 1) * before) / n;
                    before = now;
                    now = next;
                }
                slope = kCount * (x * now - before) / (x * x - 1);
                x -= now / slope;
            }
            at[i] = 0.5 * (1 - x);
            weight[i] = 1 / ((1 - x * x) * slope * slope);
        }
    }
};

}  // namespace

ShellMoments box_shell(const glm::dvec3& half_size) {
    const glm::dvec3 side = 2.0 * half_size;
    const glm::dvec3 faces(side.y * side.z, side.z * side.x, side.x * side.y);
    ShellMoments out;
    out.area = 2 * (faces.x + faces.y + faces.z);
    for (int i = 0; i < 3; ++i)
        out.variances[i] = (1 + 4 * faces[i] / out.area) * side[i] * side[i] / 12;  // A.14
    return out;
}

ShellMoments ellipsoid_shell(const glm::dvec3& half_size) {
    // One octant of the unit sphere u, dA = |u / h| hx hy hz dw. The shortest half axis is c (u's
    // height z), the longest a (angle 0). Where the axes differ much the integrand bends within c /
    // b of the equator and b / a of the long axis: sinh spreads those places out.
    static const GaussLegendre kGauss;
    std::array<int, 3> order{0, 1, 2};
    std::sort(order.begin(), order.end(),
              [&](int i, int j) { return half_size[i] > half_size[j]; });
    const double a = half_size[order[0]];
    const double b = half_size[order[1]];
    const double c = half_size[order[2]];
    const double bend_z = c / b;
    const double bend_angle = b / a;
    // Law: pi / 2.
    constexpr double kQuarter = 1.57079632679489661923;
    const double end_z = std::asinh(1 / bend_z);
    const double end_angle = std::asinh(kQuarter / bend_angle);
    std::array<double, GaussLegendre::kCount> weights;  // the weights of heights
    std::array<double, GaussLegendre::kCount> z_squares;
    for (size_t j = 0; j < weights.size(); ++j) {
        const double t = end_z * kGauss.at[j];
        const double z = std::min(1.0, bend_z * std::sinh(t));
        weights[j] = kGauss.weight[j] * end_z * bend_z * std::cosh(t);
        z_squares[j] = z * z;
    }
    double area = 0;
    glm::dvec3 seconds(0.0);
    for (int i = 0; i < GaussLegendre::kCount; ++i) {
        const double s = end_angle * kGauss.at[i];
        const double angle = bend_angle * std::sinh(s);
        const double angle_weight = kGauss.weight[i] * end_angle * bend_angle * std::cosh(s);
        const double x = std::cos(angle);
        const double y = std::sin(angle);
        const double across = (b / a * x) * (b / a * x) + y * y;  // this is multiplied by b^2
        const double bend_across = bend_z * bend_z * across;
        // The sums are in lanes, because the compiler may not divide one sum by itself.
        // Law: four doubles are a vector of AVX2, and kCount is a multiple of it.
        constexpr size_t kLanes = 4;
        std::array<double, kLanes> all{};
        // Multiplied by the square of the part across the height.
        std::array<double, kLanes> level{};
        for (size_t j = 0; j < weights.size(); j += kLanes) {
            for (size_t lane = 0; lane < kLanes; ++lane) {
                const double up = z_squares[j + lane];
                // hx hy hz |u / h| = a b c sqrt(z^2 / c^2 + ...) = a b sqrt(z^2 + (c / b)^2 ...)
                const double patch = weights[j + lane] * std::sqrt(up + bend_across * (1 - up));
                all[lane] += patch;
                level[lane] += patch * (1 - up);
            }
        }
        const double scale = angle_weight * a * b;
        const double sum = scale * (all[0] + all[1] + all[2] + all[3]);
        const double across_sum = scale * (level[0] + level[1] + level[2] + level[3]);
        area += sum;
        seconds += glm::dvec3(a * a * x * x * across_sum, b * b * y * y * across_sum,
                              c * c * (sum - across_sum));
    }
    ShellMoments out;
    out.area = 8 * area;
    for (int i = 0; i < 3; ++i)
        out.variances[order[i]] = seconds[i] / area;
    return out;
}

std::optional<Primitive> fit_box(const Attributes& attributes, const Bound& bound) {
    return fit(attributes, bound, match_box, box_shell, kBoxReach);
}

std::optional<Primitive> fit_ellipsoid(const Attributes& attributes, const Bound& bound) {
    return fit(attributes, bound, match_ellipsoid, ellipsoid_shell, kEllipsoidReach);
}

bool boxlike(const Attributes& attributes) {
    return attributes.normal_moment >= kBoxMoment;
}

std::optional<ClearSolid> fit_clear_box(const Attributes& attributes, const Bound& bound) {
    return fit_clear(attributes, bound, match_box, box_shell, kBoxReach);
}

std::optional<ClearSolid> fit_clear_ellipsoid(const Attributes& attributes, const Bound& bound) {
    return fit_clear(attributes, bound, match_ellipsoid, ellipsoid_shell, kEllipsoidReach);
}

Primitive settled(Primitive primitive, const Attributes& rough, const Attributes& sure) {
    if (rough.empty() || sure.empty())
        return primitive;
    primitive.center += sure.centroid - rough.centroid;
    primitive.half_size *= std::sqrt(sure.visible_area / rough.visible_area);
    return primitive;
}

ClearSolid settled(ClearSolid clear, const Attributes& rough, const Attributes& sure) {
    if (rough.empty() || sure.empty())
        return clear;
    clear.primitive.center += sure.centroid - rough.centroid;
    clear.opacity = std::min(1.0, clear.opacity * sure.visible_area / rough.visible_area);
    return clear;
}

std::optional<ClearSolid> shell_box(const Attributes& attributes) {
    const auto found = matched(attributes, Bound{}, match_box, box_shell, kBoxReach);
    return found ? std::optional<ClearSolid>({found->primitive, found->density}) : std::nullopt;
}

std::optional<ClearSolid> shell_ellipsoid(const Attributes& attributes) {
    const auto found =
        matched(attributes, Bound{}, match_ellipsoid, ellipsoid_shell, kEllipsoidReach);
    return found ? std::optional<ClearSolid>({found->primitive, found->density}) : std::nullopt;
}

double surface_alpha(double opacity) {
    return 1 - std::sqrt(1 - std::clamp(opacity, 0.0, 1.0));
}

}  // namespace lodestone::solids
