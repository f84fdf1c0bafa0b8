// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/visible/principal_axes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lodestone::measure {
namespace {

/// Variances whose ratio is above this give no reliable axes, for they are nearly equal.
/// Taste: a larger value leaves near cubes the axes of noise, a smaller one turns more frames.
constexpr double kNearlyEqual = 0.93;
/// The rise of in_frame() that is worth a turn.
/// Taste: noise of rays is below; a larger value leaves rounded boxes at eigenvectors.
constexpr double kWorthTurning = 0.05;

struct QuarticTerm {
    int x, y, z;
    double count;  // how often x^i y^j z^k occurs in (x + y + z)^4
};

/// Law: the terms of (x + y + z)^4 and their multinomial coefficients.
constexpr std::array<QuarticTerm, 15> kPowers{{{4, 0, 0, 1},
                                               {0, 4, 0, 1},
                                               {0, 0, 4, 1},
                                               {3, 1, 0, 4},
                                               {3, 0, 1, 4},
                                               {1, 3, 0, 4},
                                               {0, 3, 1, 4},
                                               {1, 0, 3, 4},
                                               {0, 1, 3, 4},
                                               {2, 2, 0, 6},
                                               {2, 0, 2, 6},
                                               {0, 2, 2, 6},
                                               {2, 1, 1, 12},
                                               {1, 2, 1, 12},
                                               {1, 1, 2, 12}}};

std::array<std::array<double, 5>, 3> powers_of(const glm::dvec3& v) {
    std::array<std::array<double, 5>, 3> out{};
    for (int i = 0; i < 3; ++i) {
        auto& row = out[static_cast<size_t>(i)];
        row[0] = 1;
        for (size_t n = 1; n < 5; ++n)
            row[n] = row[n - 1] * v[i];
    }
    return out;
}

double product(const std::array<std::array<double, 5>, 3>& powers, const QuarticTerm& power) {
    return powers[0][static_cast<size_t>(power.x)] * powers[1][static_cast<size_t>(power.y)] *
           powers[2][static_cast<size_t>(power.z)];
}

/// The frame turned by `angle` in the plane of its axes i and j.
glm::dmat3 turned(const glm::dmat3& axes, int i, int j, double angle) {
    glm::dmat3 out = axes;
    out[i] = std::cos(angle) * axes[i] + std::sin(angle) * axes[j];
    out[j] = std::cos(angle) * axes[j] - std::sin(angle) * axes[i];
    return out;
}

/// The best turn in one plane. Over the angle, in_frame is a constant plus one cosine of four
/// times the angle, so three values give the maximum in closed form.
glm::dmat3 best_in_plane(const NormalMoments& normals, const glm::dmat3& axes, int i, int j) {
    // Law: 45 degrees, an eighth of a turn.
    constexpr double kQuarter = std::numbers::pi / 4;
    const double at_0 = normals.in_frame(axes);
    const double at_45 = normals.in_frame(turned(axes, i, j, kQuarter));
    const double at_22 = normals.in_frame(turned(axes, i, j, kQuarter / 2));
    const double cosine = 0.5 * (at_0 - at_45);
    const double sine = at_22 - 0.5 * (at_0 + at_45);
    if (std::hypot(cosine, sine) < 1e-12)
        return axes;
    return turned(axes, i, j, std::atan2(sine, cosine) / 4);
}

/// Turns in all three planes in turn until none helps, from a few starts: one may be a saddle.
glm::dmat3 best_in_space(const NormalMoments& normals, const glm::dmat3& axes) {
    // Radians by which a start is turned in a plane.
    // Taste: any angle between the symmetries of a cube (0 and 1.57) will do.
    constexpr double kStart = 0.5;
    glm::dmat3 best = axes;
    double best_value = normals.in_frame(axes);
    for (int start = 0; start < 8; ++start) {
        glm::dmat3 frame = axes;
        for (int plane = 0; plane < 3; ++plane) {
            if (((start >> plane) & 1) != 0)
                frame = turned(frame, plane, (plane + 1) % 3, kStart);
        }
        double value = normals.in_frame(frame);
        for (int sweep = 0; sweep < 50; ++sweep) {
            for (int plane = 0; plane < 3; ++plane)
                frame = best_in_plane(normals, frame, plane, (plane + 1) % 3);
            const double next = normals.in_frame(frame);
            if (next - value < 1e-10)
                break;
            value = next;
        }
        value = normals.in_frame(frame);
        if (value > best_value + 1e-9) {
            best_value = value;
            best = frame;
        }
    }
    return best;
}

}  // namespace

void NormalMoments::add(const glm::dvec3& normal, double weight) {
    const auto powers = powers_of(normal);
    for (size_t i = 0; i < kPowers.size(); ++i)
        sums_[i] += weight * product(powers, kPowers[i]);
    weight_ += weight;
}

double NormalMoments::along(const glm::dvec3& axis) const {
    if (!(weight_ > 0))
        return 0;
    const auto powers = powers_of(axis);
    double sum = 0;
    for (size_t i = 0; i < kPowers.size(); ++i)
        sum += kPowers[i].count * sums_[i] * product(powers, kPowers[i]);
    return sum / weight_;
}

double NormalMoments::in_frame(const glm::dmat3& axes) const {
    return along(axes[0]) + along(axes[1]) + along(axes[2]);
}

glm::dmat3 principal_axes(const glm::dmat3& moments, const NormalMoments& normals) {
    const double total = trace(moments);
    // A point has no axes; a scale without units keeps the solver away from underflow.
    const SymmetricEigen eigen =
        total > 0 && std::isfinite(total) ? eigen_symmetric(moments / total) : SymmetricEigen{};
    const glm::dvec3 values = glm::max(eigen.values, glm::dvec3(1e-12));
    const double first = values.y / values.x;
    const double second = values.z / values.y;
    glm::dmat3 best = eigen.axes;
    if (values.z > kNearlyEqual * values.x)
        best = best_in_space(normals, eigen.axes);
    else if (first >= second && first > kNearlyEqual)
        best = best_in_plane(normals, eigen.axes, 0, 1);
    else if (second > kNearlyEqual)
        best = best_in_plane(normals, eigen.axes, 1, 2);
    const bool worth = normals.in_frame(best) > normals.in_frame(eigen.axes) + kWorthTurning;
    return worth ? best : eigen.axes;
}

}  // namespace lodestone::measure
