// SPDX-License-Identifier: GPL-3.0-or-later
#include "solids/match_solids.h"

#include "solids/keep_on_floor.h"
#include "solids/matching_step.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestone::solids {
namespace {

// The power by which sizes follow the missing area.
// Taste: a larger power may swing; the area grows more slowly, as solids hide each other.
constexpr double kGrowth = 0.7;
// The largest change of size in one round.
// Taste: a larger one is no correction.
constexpr double kMostStep = 1.5;

/// How far off the solids are, as shares of what is wanted: area, centroid (radii of gyration),
/// variances.
struct MatchError {
    double area = 0;
    double centroid = 0;
    double shape = 0;

    explicit MatchError(const MatchResidual& missing)
        : area(std::abs(missing.area)), centroid(glm::length(missing.centroid)) {
        for (int i = 0; i < 3; ++i)
            shape += glm::dot(missing.variances[i], missing.variances[i]);
        shape = std::sqrt(shape);
    }
    MatchError(double of_area, double of_centroid, double of_shape)
        : area(of_area), centroid(of_centroid), shape(of_shape) {}
};

}  // namespace

void match_composite(Composite& composite, const Attributes& wanted, double floor,
                     const VisibleSolids& visible, bool shape, int rounds, const Job& job) {
    // Rounds with few rays go most of the way; rounds with all rays go the end of it, as often as
    // it pays.
    // The share of the rays in the first rounds.
    // Taste: a larger one takes longer and learns little more.
    constexpr double kFew = 1.0 / 8;
    // Law: all rays.
    constexpr double kAll = 1;
    // The rounds with all rays.
    // Taste: more come nearer than the rays can tell.
    constexpr int kLast = 3;
    // The rounds with all rays where solids are far off, because they stand and hide much of each
    // other.
    // Fitted: by tests/bench/sheets/bench_replace.py, a cube by 8 solids.
    constexpr int kMost = 8;
    const MatchError far{0.01, 0.003, 0.005};
    const MatchError rough{0.004, 0.004, 0.004};
    const MatchError exact{0.001, 0.0005, 0.001};
    // The rounds after which the ratios of area and variances are enough, as for a single solid:
    // plates around a closed body have no size that gives both its area and its variances.
    // Taste: more rounds try longer for a size that does not exist.
    constexpr int kPatience = 5;
    const auto within = [&](const MatchError& miss, const MatchError& most) {
        return miss.area <= most.area &&
               (!shape || (miss.centroid <= most.centroid && miss.shape <= most.shape));
    };
    const auto worst = [&](const MatchError& miss) {
        const double area = miss.area / exact.area;
        return shape ? std::max({area, miss.centroid / exact.centroid, miss.shape / exact.shape})
                     : area;
    };
    Composite best;
    double least = std::numeric_limits<double>::infinity();
    int last = 0;  // rounds with all rays
    bool size = true;
    std::vector<measure::SurfaceInertia> each;
    BroydenCorrection experience;
    bool near = false;
    for (int round = 0; last < (near ? kLast : kMost); ++round) {
        measure::SurfaceInertia now = visible.of(composite, last > 0 ? kAll : kFew, job, &each);
        if (now.empty())
            break;
        size = size && (last > 0 || round < kPatience);
        if (last == 0 &&
            (within(MatchError(match_residual(now, wanted, size)), rough) || round >= rounds)) {
            ++last;
            now = visible.of(composite, kAll, job, &each);
            if (now.empty())
                break;
        } else if (last > 0) {
            ++last;
        }
        const MatchResidual missing = match_residual(now, wanted, size);
        const double off = worst(MatchError(missing));
        if (last > 0 && off < least) {
            least = off;
            best = composite;
            near = !shape || within(MatchError(missing), far);
        }
        if (last > 0 && off <= 1)
            break;
        if (shape) {
            // Few rays are too unsure to learn from.
            gauss_newton_step(composite, now, each, missing, size, floor,
                              last > 0 ? &experience : nullptr);
            continue;
        }
        const double scale =
            std::clamp(std::pow(wanted.visible_area / now.area, kGrowth), 1 / kMostStep, kMostStep);
        for (Solid& solid : composite.solids) {
            solid.primitive.half_size *= scale;
            solid.primitive = kept_above(solid.primitive, solid.box, floor);
        }
    }
    if (!best.solids.empty())
        composite = std::move(best);
}

void settle_composite(Composite& composite, const Attributes& wanted, double floor,
                      const VisibleSolids& visible, const Job& job) {
    // How far above the floor a solid still stands, in radii of gyration.
    // Law: rounding of double precision, with a large margin.
    constexpr double kStands = 1e-6;
    // The largest change of size when solids are settled.
    // Taste: a larger one would hide an error of matching.
    constexpr double kMostScale = 1.02;
    std::vector<measure::SurfaceInertia> each;
    const measure::SurfaceInertia now = visible.of(composite, 1, job, &each);
    if (now.empty())
        return;
    const double scale =
        std::clamp(std::sqrt(wanted.visible_area / now.area), 1 / kMostScale, kMostScale);
    const glm::dvec3 pivot(now.center.x, now.center.y, floor);
    std::vector<bool> stands;
    double follows = 0;  // the share of a move along Z that they follow
    for (size_t i = 0; i < each.size(); ++i) {
        const Solid& solid = composite.solids[i];
        stands.push_back(reach_of(solid.primitive, solid.box).low <=
                         floor + kStands * wanted.radius_of_gyration());
        follows += each[i].area / now.area * (stands[i] ? 0.5 : 1);
    }
    glm::dvec3 move = wanted.centroid - (pivot + scale * (now.center - pivot));
    move.z /= std::clamp(follows, 0.5, 1.0);
    for (size_t i = 0; i < each.size(); ++i) {
        Primitive& primitive = composite.solids[i].primitive;
        const bool box = composite.solids[i].box;
        primitive.center = pivot + scale * (primitive.center - pivot) + move;
        primitive.half_size *= scale;
        if (stands[i])
            primitive = standing_on(primitive, box, floor);
        primitive = kept_above(primitive, box, floor);
    }
}

}  // namespace lodestone::solids
