// SPDX-License-Identifier: GPL-3.0-or-later
#include "solids/matching_step.h"

#include "solids/keep_on_floor.h"

#include <glm/exponential.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace lodestone::solids {
namespace {

constexpr size_t kNumbers = BroydenCorrection::kNumbers;
// The unknowns of a solid.
// Law: a move along three axes, logarithms of three stretches.
constexpr size_t kUnknowns = 6;
// The largest move of a step, in radii of gyration.
// Taste: a larger one goes farther than the linear step is right.
constexpr double kMostMove = 0.5;
// The largest logarithm of a stretch in a step: half of a solid.
// Taste: a larger one goes farther than the linear step is right.
constexpr double kMostStretch = 0.4;
using Row = BroydenCorrection::Row;

double trace_of(const glm::dmat3& m) {
    return m[0][0] + m[1][1] + m[2][2];
}

/// Numbers whose squares add up to those of the parts; elements off the diagonal count twice.
Row numbers_of(const MatchResidual& of) {
    const double twice = std::sqrt(2.0);
    const glm::dmat3& v = of.variances;
    return {of.area, of.centroid.x, of.centroid.y,   of.centroid.z,   v[0][0],
            v[1][1], v[2][2],       twice * v[0][1], twice * v[0][2], twice * v[1][2]};
}

/// How much the logarithm of a shell's area grows with that of each half size. source: for
/// ellipsoids Thomsen's formula, right within a hundredth; with a power of 1 it is a box's area.
glm::dvec3 growth_of(const Solid& solid) {
    const double power = solid.box ? 1 : 1.6075;
    const glm::dvec3 p = glm::pow(solid.primitive.half_size, glm::dvec3(power));
    const glm::dvec3 faces(p.y * p.z, p.z * p.x, p.x * p.y);
    return 1.0 - faces / (faces.x + faces.y + faces.z);
}

/// The lowest point of a solid, and how much lower it gets with the logarithm of each half size.
struct LowestPoint {
    double low = 0;
    glm::dvec3 sinks{0.0};
};

LowestPoint foot_of(const Solid& solid) {
    const Primitive& primitive = solid.primitive;
    LowestPoint out;
    out.low = reach_of(primitive, solid.box).low;
    const double half = primitive.center.z - out.low;
    for (int i = 0; i < 3; ++i) {
        const double part = std::abs(primitive.axes[i].z) * primitive.half_size[i];
        out.sinks[i] = solid.box ? part : half > 0 ? part * part / half : 0;
    }
    return out;
}

/// The effects of one unknown on the whole.
class MatchingJacobian {
public:
    MatchingJacobian(const measure::SurfaceInertia& now, bool size)
        : now_(now),
          variances_(now.moments / now.area),
          trace_(trace_of(variances_)),
          gyration_(std::sqrt(trace_)),
          size_(size) {}

    double gyration() const { return gyration_; }

    Row of_move(const measure::SurfaceInertia& part, const glm::dvec3& along) const {
        const glm::dvec3 arm = part.center - now_.center;
        const double share = part.area / now_.area;
        return row(0, share * along,
                   share * (glm::outerProduct(along, arm) + glm::outerProduct(arm, along)));
    }
    Row of_stretch(const measure::SurfaceInertia& part, const glm::dvec3& center,
                   const glm::dvec3& axis, double growth) const {
        // A solid that grows hides more of the others.
        // The share of its growth that is seen.
        // Taste: a larger one makes steps smaller and slower.
        constexpr double kSeen = 0.7;
        const glm::dvec3 arm = part.center - now_.center;
        const glm::dvec3 shift = glm::dot(axis, part.center - center) * axis;
        const glm::dmat3 along = glm::outerProduct(axis, axis);
        const double share = part.area / now_.area;
        const double more = kSeen * growth;
        const glm::dmat3 own = part.moments / part.area;
        const glm::dmat3 spread = along * own + own * along + glm::outerProduct(shift, arm) +
                                  glm::outerProduct(arm, shift) +
                                  more * (own + glm::outerProduct(arm, arm) - variances_);
        return row(share * more, share * (shift + more * arm), share * spread);
    }

private:
    Row row(double area, const glm::dvec3& centroid, const glm::dmat3& variances) const {
        MatchResidual out{area, centroid / gyration_, variances / trace_};
        if (!size_)
            out.variances -= variances_ * (trace_of(out.variances) / trace_);
        return numbers_of(out);
    }

    const measure::SurfaceInertia& now_;
    glm::dmat3 variances_;
    double trace_;
    double gyration_;
    bool size_;
};

/// Solves a symmetric system in place, by elimination; unknowns that it does not determine are 0.
std::vector<double> solved(std::vector<std::vector<double>> matrix, std::vector<double> right) {
    const size_t count = right.size();
    double largest = 0;
    for (size_t i = 0; i < count; ++i)
        largest = std::max(largest, matrix[i][i]);
    std::vector<uint8_t> told(count, 0);
    for (size_t i = 0; i < count; ++i) {
        // Law: rounding of double precision, with a large margin.
        constexpr double kLeast = 1e-9;
        if (!(matrix[i][i] > kLeast * largest))
            continue;
        told[i] = 1;
        for (size_t k = 0; k < count; ++k) {
            if (k == i)
                continue;
            const double factor = matrix[k][i] / matrix[i][i];
            for (size_t j = i; j < count; ++j)
                matrix[k][j] -= factor * matrix[i][j];
            right[k] -= factor * right[i];
        }
    }
    for (size_t i = 0; i < count; ++i)
        right[i] = told[i] != 0 ? right[i] / matrix[i][i] : 0;
    return right;
}

/// The unknowns of all solids, with moves in metres.
std::vector<double> places_of(const Composite& composite) {
    std::vector<double> out;
    for (const Solid& solid : composite.solids) {
        for (int axis = 0; axis < 3; ++axis)
            out.push_back(solid.primitive.center[axis]);
        for (int axis = 0; axis < 3; ++axis)
            out.push_back(std::log(solid.primitive.half_size[axis]));
    }
    return out;
}

}  // namespace

void BroydenCorrection::learn(const std::vector<double>& at, double unit,
                              const std::vector<double>& weight, const Row& missing) {
    // The square of the smallest step that tells anything.
    // Law: rounding of double precision.
    constexpr double kLeast = 1e-16;
    corrections_.resize(at.size(), Row{});
    if (effect_.size() == at.size()) {
        std::vector<double> moved(at.size(), 0);
        double square = 0;
        Row surprise{};
        for (size_t row = 0; row < kNumbers; ++row)
            surprise[row] = missing_[row] - missing[row];
        for (size_t i = 0; i < at.size(); ++i) {
            moved[i] = (at[i] - at_[i]) / (i % kUnknowns < 3 ? unit : 1);
            square += weight[i] > 0 ? moved[i] * moved[i] / weight[i] : 0;
            for (size_t row = 0; row < kNumbers; ++row)
                surprise[row] -= moved[i] * effect_[i][row];
        }
        for (size_t i = 0; square > kLeast && std::isfinite(square) && i < at.size(); ++i) {
            if (!(weight[i] > 0))
                continue;
            for (size_t row = 0; row < kNumbers; ++row)
                corrections_[i][row] += moved[i] / weight[i] / square * surprise[row];
        }
    }
    at_ = at;
    missing_ = missing;
    effect_.clear();
}

MatchResidual match_residual(const measure::SurfaceInertia& now, const Attributes& wanted,
                             bool size) {
    const glm::dmat3 should = wanted.moments / wanted.visible_area;
    const double trace = trace_of(should);
    MatchResidual out;
    out.area = wanted.visible_area / now.area - 1;
    if (!(trace > 0) || !(trace_of(now.moments) > 0))
        return out;
    const glm::dmat3 is = now.moments * (size ? 1 / now.area : trace / trace_of(now.moments));
    out.centroid = (wanted.centroid - now.center) / std::sqrt(trace);
    out.variances = (should - is) / trace;
    return out;
}

void gauss_newton_step(Composite& composite, const measure::SurfaceInertia& now,
                       const std::vector<measure::SurfaceInertia>& each,
                       const MatchResidual& missing, bool size, double floor,
                       BroydenCorrection* experience) {
    const size_t solids = composite.solids.size();
    const MatchingJacobian effects(now, size);
    const double mean = now.area / static_cast<double>(solids);
    if (!(mean > 0) || !(effects.gyration() > 0))
        return;
    // The unknowns are in radii of gyration and in logarithms, each divided by the root of its
    // weight: otherwise an unknown with little effect would not be moved at all.
    std::vector<Row> effect(kUnknowns * solids);
    std::vector<double> weight(effect.size(), 0);
    std::vector<LowestPoint> feet;
    for (size_t i = 0; i < solids; ++i) {
        const Solid& solid = composite.solids[i];
        feet.push_back(foot_of(solid));
        if (each[i].empty())
            continue;
        // The least area of a solid in its weight, in parts of the mean.
        // Taste: a smaller one moves hidden solids farther, for little effect.
        constexpr double kLeastShare = 0.1;
        const double own = mean / std::max(each[i].area, kLeastShare * mean);
        const glm::dvec3 growth = growth_of(solid);
        for (int axis = 0; axis < 3; ++axis) {
            const size_t move = kUnknowns * i + static_cast<size_t>(axis);
            glm::dvec3 along(0.0);
            along[axis] = effects.gyration();
            effect[move] = effects.of_move(each[i], along);
            effect[move + 3] = effects.of_stretch(each[i], solid.primitive.center,
                                                  solid.primitive.axes[axis], growth[axis]);
            weight[move] = weight[move + 3] = own;
        }
    }
    const Row wanted = numbers_of(missing);
    if (experience != nullptr) {
        experience->learn(places_of(composite), effects.gyration(), weight, wanted);
        for (size_t unknown = 0; unknown < effect.size(); ++unknown) {
            for (size_t row = 0; row < kNumbers; ++row)
                effect[unknown][row] += experience->corrections()[unknown][row];
        }
        experience->expect(effect);
    }
    std::vector<size_t> standing;  // solids that are kept on the floor
    std::vector<double> step(effect.size(), 0);
    const auto sinks = [&](size_t solid, size_t unknown) {
        // The effects on the height of the solid's lowest point, in radii of gyration.
        if (unknown < 3)
            return unknown == 2 ? 1.0 : 0.0;
        return -feet[solid].sinks[static_cast<int>(unknown) - 3] / effects.gyration();
    };
    for (size_t round = 0; round <= solids; ++round) {
        const size_t count = kNumbers + standing.size();
        const auto entry = [&](size_t row, size_t unknown) {
            if (row < kNumbers)
                return effect[unknown][row];
            const size_t solid = standing[row - kNumbers];
            return unknown / kUnknowns == solid ? sinks(solid, unknown % kUnknowns) : 0.0;
        };
        std::vector<std::vector<double>> matrix(count, std::vector<double>(count, 0));
        std::vector<double> right(wanted.begin(), wanted.end());
        for (const size_t solid : standing)
            right.push_back((floor - feet[solid].low) / effects.gyration());
        for (size_t unknown = 0; unknown < effect.size(); ++unknown) {
            if (weight[unknown] == 0)
                continue;
            for (size_t a = 0; a < count; ++a) {
                const double left = weight[unknown] * entry(a, unknown);
                for (size_t b = 0; left != 0 && b < count; ++b)
                    matrix[a][b] += left * entry(b, unknown);
            }
        }
        const std::vector<double> pull = solved(matrix, right);
        for (size_t unknown = 0; unknown < effect.size(); ++unknown) {
            step[unknown] = 0;
            for (size_t row = 0; row < count; ++row)
                step[unknown] += weight[unknown] * entry(row, unknown) * pull[row];
        }
        const size_t before = standing.size();
        for (size_t i = 0; i < solids; ++i) {
            // How far below the floor a solid may be, in radii of gyration.
            // Taste: a smaller one keeps more solids on the floor for nothing that is seen.
            constexpr double kTolerance = 1e-6;
            double low = feet[i].low;
            for (size_t unknown = 0; unknown < kUnknowns; ++unknown)
                low += effects.gyration() * sinks(i, unknown) * step[kUnknowns * i + unknown];
            if (low < floor - kTolerance * effects.gyration() && !each[i].empty() &&
                std::find(standing.begin(), standing.end(), i) == standing.end())
                standing.push_back(i);
        }
        if (standing.size() == before)
            break;
    }
    double most = 0;
    for (size_t unknown = 0; unknown < step.size(); ++unknown) {
        if (!std::isfinite(step[unknown]))
            return;
        most = std::max(
            most, std::abs(step[unknown]) / (unknown % kUnknowns < 3 ? kMostMove : kMostStretch));
    }
    const double part = 1 / std::max(1.0, most);
    for (size_t i = 0; i < solids; ++i) {
        Solid& solid = composite.solids[i];
        for (int axis = 0; axis < 3; ++axis) {
            const size_t move = kUnknowns * i + static_cast<size_t>(axis);
            solid.primitive.center[axis] += part * effects.gyration() * step[move];
            solid.primitive.half_size[axis] *= std::exp(part * step[move + 3]);
        }
        solid.primitive = kept_above(solid.primitive, solid.box, floor);
    }
}

}  // namespace lodestone::solids
