// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/maths.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace lodestone {

Affine Affine::from_rows(const double rows[12]) {
    Affine out;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            out.linear[column][row] = rows[4 * row + column];
        out.offset[row] = rows[4 * row + 3];
    }
    return out;
}

void Affine::to_rows(double rows[12]) const {
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            rows[4 * row + column] = linear[column][row];
        rows[4 * row + 3] = offset[row];
    }
}

bool Affine::finite() const {
    double rows[12];
    to_rows(rows);
    return std::all_of(rows, rows + 12, [](double value) { return std::isfinite(value); });
}

bool all_finite(std::span<const glm::vec3> points) {
    // The sum has no branch: only a coordinate that is not finite gives anything but 0.
    glm::vec3 sum(0.0f);
    for (const glm::vec3& p : points)
        sum += p - p;
    return sum == glm::vec3(0.0f);
}

namespace {

/// Whether a symmetric matrix is diagonal but for rounding.
bool diagonal(const glm::dmat3& a) {
    const double off = a[0][1] * a[0][1] + a[0][2] * a[0][2] + a[1][2] * a[1][2];
    const double on = a[0][0] * a[0][0] + a[1][1] * a[1][1] + a[2][2] * a[2][2];
    return off <= 1e-32 * on || off == 0;
}

}  // namespace

double stretch(const Affine& transform) {
    const glm::dmat3 square = glm::transpose(transform.linear) * transform.linear;
    if (diagonal(square))  // turned, mirrored or scaled along its own axes, as most transforms are
        return std::sqrt(std::max({square[0][0], square[1][1], square[2][2]}));
    return std::sqrt(std::max(0.0, eigen_symmetric(square).values.x));
}

SymmetricEigen eigen_symmetric(const glm::dmat3& matrix) {
    // Cyclic Jacobi rotations: unconditionally stable and exact enough for 3x3 in a few sweeps.
    glm::dmat3 a = matrix;
    glm::dmat3 axes(1.0);
    for (int sweep = 0; sweep < 32; ++sweep) {
        if (diagonal(a))
            break;
        for (int p = 0; p < 2; ++p) {
            for (int q = p + 1; q < 3; ++q) {
                if (a[p][q] == 0)
                    continue;
                const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
                const double t =
                    (theta >= 0 ? 1.0 : -1.0) / (std::abs(theta) + std::sqrt(theta * theta + 1));
                const double c = 1 / std::sqrt(t * t + 1);
                const double s = t * c;
                glm::dmat3 rotation(1.0);
                rotation[p][p] = rotation[q][q] = c;
                rotation[q][p] = s;
                rotation[p][q] = -s;
                a = glm::transpose(rotation) * a * rotation;
                axes = axes * rotation;
            }
        }
    }
    std::array<int, 3> order{0, 1, 2};
    std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return a[i][i] > a[j][j]; });
    SymmetricEigen out;
    for (int i = 0; i < 3; ++i) {
        out.values[i] = a[order[i]][order[i]];
        out.axes[i] = axes[order[i]];
    }
    if (glm::determinant(out.axes) < 0)
        out.axes[2] = -out.axes[2];
    return out;
}

Bound bound_of(std::span<const glm::vec3> points) {
    Bound bound;
    for (const glm::vec3& point : points)
        bound.box.add(glm::dvec3(point));
    if (bound.empty())
        return bound;
    bound.center = bound.box.center();
    double square = 0;
    for (const glm::vec3& point : points) {
        const glm::dvec3 arm = glm::dvec3(point) - bound.center;
        square = std::max(square, glm::dot(arm, arm));
    }
    bound.radius = std::sqrt(square);
    return bound;
}

Bound merged(const Bound& a, const Bound& b) {
    if (a.empty())
        return b;
    if (b.empty())
        return a;
    Bound out;
    out.box = a.box;
    out.box.add(b.box);
    out.center = out.box.center();
    // The radius is the smaller of two valid ones: around both spheres, or around the box.
    out.radius = std::max(glm::length(a.center - out.center) + a.radius,
                          glm::length(b.center - out.center) + b.radius);
    out.radius = std::min(out.radius, 0.5 * glm::length(out.box.size()));
    return out;
}

Bound transformed(const Bound& bound, const Affine& transform) {
    return transformed(bound, transform, stretch(transform));
}

Bound transformed(const Bound& bound, const Affine& transform, double stretch) {
    if (bound.empty())
        return bound;
    Bound out;
    out.center = transform(bound.center);
    out.radius = bound.radius * stretch;
    // The box is made axis by axis, in the order in which a point is transformed: it is the box of
    // the eight corners to the last bit.
    const glm::dmat3& m = transform.linear;
    const auto sum = [&](auto pick) {
        const glm::dvec3 x = pick(m[0] * bound.box.low.x, m[0] * bound.box.high.x);
        const glm::dvec3 y = pick(m[1] * bound.box.low.y, m[1] * bound.box.high.y);
        const glm::dvec3 z = pick(m[2] * bound.box.low.z, m[2] * bound.box.high.z);
        return ((x + y) + z) + transform.offset;
    };
    out.box.low = sum([](const glm::dvec3& a, const glm::dvec3& b) { return glm::min(a, b); });
    out.box.high = sum([](const glm::dvec3& a, const glm::dvec3& b) { return glm::max(a, b); });
    return out;
}

double distance(const Bound& bound, const glm::dvec3& point) {
    const double sphere = glm::length(point - bound.center) - bound.radius;
    return std::max({0.0, sphere, glm::length(bound.box.beyond(point))});
}

}  // namespace lodestone
