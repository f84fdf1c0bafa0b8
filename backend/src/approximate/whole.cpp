// SPDX-License-Identifier: GPL-3.0-or-later
#include "approximate/whole.h"

#include "approximate/standing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestone::approximate {
namespace {

// What solids show grows with less than the square of their size: they hide more of each other.
constexpr double kGrowth = 0.7;
// Of one round; more than this is no correction.
constexpr double kMostStep = 1.5;

glm::dmat3 power(const glm::dmat3& symmetric, double exponent, double least) {
    const Eigen eigen = eigen_symmetric(symmetric);
    glm::dmat3 along(0.0);
    for (int i = 0; i < 3; ++i)
        along[i][i] = std::pow(std::max(eigen.values[i], least), exponent);
    return eigen.axes * along * glm::transpose(eigen.axes);
}

/// What takes points of one covariance to another, turning nothing.
glm::dmat3 map_between(const glm::dmat3& from, const glm::dmat3& to) {
    const double least = 1e-9 * (to[0][0] + to[1][1] + to[2][2]);
    const glm::dmat3 root = power(to, 0.5, least);
    return root * power(root * from * root, -0.5, least * least) * root;
}

/// How far off in shares of what is wanted: area, centroid (radii of gyration), variances.
struct Miss {
    double area = 0;
    double centroid = 0;
    double shape = 0;
};

/// `size`: of the variances, what is wanted counts, else their ratios alone.
Miss miss_of(const measure::SurfaceInertia& now, const Attributes& wanted, bool size) {
    const auto trace_of = [](const glm::dmat3& m) { return m[0][0] + m[1][1] + m[2][2]; };
    const glm::dmat3 should = wanted.moments / wanted.visible_area;
    const double trace = trace_of(should);
    Miss out;
    out.area = std::abs(now.area / wanted.visible_area - 1);
    if (!(trace > 0) || !(trace_of(now.moments) > 0))
        return out;
    const glm::dmat3 is = now.moments * (size ? 1 / now.area : trace / trace_of(now.moments));
    out.centroid = glm::length(now.center - wanted.centroid) / std::sqrt(trace);
    for (int i = 0; i < 3; ++i)
        out.shape += glm::dot(is[i] - should[i], is[i] - should[i]);
    out.shape = std::sqrt(out.shape) / trace;
    return out;
}

}  // namespace

void match_whole(Composite& composite, const Attributes& wanted, double floor,
                 const VisibleSolids& visible, bool shape, int rounds, const Job& job) {
    // Rounds of few rays go the way; all rays go the last of it, as often as it pays.
    constexpr double kFew = 0.25;
    constexpr int kLast = 4;
    constexpr Miss kRough{0.004, 0.004, 0.004};
    constexpr Miss kExact{0.001, 0.0005, 0.001};
    // Plates around a closed body have no size that gives both its area and its variances: after so
    // many rounds the ratios of these are enough, as for a single solid.
    constexpr int kPatience = 5;
    const auto within = [&](const Miss& miss, const Miss& most) {
        return miss.area <= most.area &&
               (!shape || (miss.centroid <= most.centroid && miss.shape <= most.shape));
    };
    const auto worst = [&](const Miss& miss) {
        const double area = miss.area / kExact.area;
        return shape ? std::max({area, miss.centroid / kExact.centroid, miss.shape / kExact.shape})
                     : area;
    };
    Composite best;
    double least = std::numeric_limits<double>::infinity();
    int last = 0;  // rounds with all rays
    bool size = true;
    for (int round = 0; last < kLast; ++round) {
        measure::SurfaceInertia now = visible.of(composite, last > 0 ? 1 : kFew, job);
        if (now.empty())
            break;
        size = size && (last > 0 || round < kPatience);
        if (last == 0 && (within(miss_of(now, wanted, size), kRough) || round >= rounds)) {
            ++last;
            now = visible.of(composite, 1, job);
            if (now.empty())
                break;
        } else if (last > 0) {
            ++last;
        }
        const double off = worst(miss_of(now, wanted, size));
        if (last > 0 && off < least) {
            least = off;
            best = composite;
        }
        if (last > 0 && off <= 1)
            break;
        glm::dmat3 map = map_between(now.moments / now.area, wanted.moments / wanted.visible_area);
        // What is flat or has no extent at all cannot be told how to stretch.
        const Eigen stretches = eigen_symmetric(map);
        if (!shape || !(stretches.values.z > 1 / kMostStep && stretches.values.x < kMostStep))
            map = glm::dmat3(1.0);
        const double whole = std::cbrt(glm::determinant(map));
        if (!size)
            map = map / whole;
        const double scale =
            std::clamp(std::pow(wanted.visible_area / now.area, kGrowth) / (size ? whole : 1),
                       1 / kMostStep, kMostStep);
        for (Solid& solid : composite.solids) {
            Primitive& primitive = solid.primitive;
            if (shape)
                primitive.center = wanted.centroid + map * (primitive.center - now.center);
            for (int i = 0; i < 3; ++i)
                primitive.half_size[i] *= scale * glm::length(map * primitive.axes[i]);
            primitive = kept_above(primitive, solid.box, floor);
        }
    }
    if (!best.solids.empty())
        composite = std::move(best);
}

}  // namespace lodestone::approximate
