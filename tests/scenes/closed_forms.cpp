// SPDX-License-Identifier: GPL-3.0-or-later
#include "scenes/closed_forms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace lodestone::closed_forms {
namespace {

glm::dmat3 diagonal(double x, double y, double z) {
    return glm::dmat3(glm::dvec3(x, 0, 0), glm::dvec3(0, y, 0), glm::dvec3(0, 0, z));
}

struct Node {
    double at;
    double weight;
};

/// Nodes and weights of Gauss-Legendre quadrature on 0...1.
std::array<Node, 16> gauss() {
    constexpr int kCount = 16;
    std::array<Node, kCount> nodes{};
    for (int i = 0; i < kCount; ++i) {
        double x = std::cos(kPi * (i + 0.75) / (kCount + 0.5));
        double slope = 1;
        for (int step = 0; step < 64; ++step) {
            double before = 1;
            double value = x;
            for (int n = 2; n <= kCount; ++n) {
                const double next = ((2 * n - 1) * x * value - (n - 1) * before) / n;
                before = value;
                value = next;
            }
            slope = kCount * (x * value - before) / (x * x - 1);
            const double move = value / slope;
            x -= move;
            if (std::abs(move) < 1e-16)
                break;
        }
        nodes[static_cast<size_t>(i)] = {0.5 * (1 - x), 1 / ((1 - x * x) * slope * slope)};
    }
    return nodes;
}

/// Nodes on 0...1 in panels that halve towards 0, down to about `finest`: an integrand that bends
/// within that width of 0 is smooth on every panel.
std::vector<Node> graded_nodes(double finest) {
    static const std::array<Node, 16> kUnit = gauss();
    std::vector<Node> nodes;
    double high = 1;
    for (int panel = 0; panel < 60; ++panel) {
        const bool last = panel == 59 || high <= 0.5 * finest;
        const double low = last ? 0 : 0.5 * high;
        for (const Node& node : kUnit)
            nodes.push_back({low + (high - low) * node.at, (high - low) * node.weight});
        if (last)
            break;
        high = low;
    }
    return nodes;
}

}  // namespace

SurfaceInertia of_sphere(double radius) {
    SurfaceInertia out;
    out.area = 4 * kPi * radius * radius;
    out.moments = glm::dmat3(out.area * radius * radius / 3);
    return out;
}

SurfaceInertia of_box(double a, double b, double c) {
    SurfaceInertia out;
    out.area = 2 * (a * b + b * c + c * a);
    // Two faces at +-a/2, four that span it.
    out.moments =
        diagonal(a * a * (b * c / 2 + a * (b + c) / 6), b * b * (c * a / 2 + b * (c + a) / 6),
                 c * c * (a * b / 2 + c * (a + b) / 6));
    return out;
}

SurfaceInertia of_closed_cylinder(double radius, double height) {
    const double r = radius;
    const double h = height;
    SurfaceInertia out;
    out.area = 2 * kPi * r * (r + h);
    const double across = kPi * r * r * r * (h + r / 2);
    out.moments = diagonal(across, across, kPi * r * h * h * (h / 6 + r / 2));
    return out;
}

SurfaceInertia of_disc(double radius) {
    SurfaceInertia out;
    out.area = kPi * radius * radius;
    const double across = out.area * radius * radius / 4;
    out.moments = diagonal(across, across, 0);
    return out;
}

SurfaceInertia of_ellipsoid(const glm::dvec3& half_size) {
    std::array<int, 3> order{0, 1, 2};
    std::sort(order.begin(), order.end(),
              [&](int i, int j) { return half_size[i] > half_size[j]; });
    // a >= b >= c; only ratios go into the quadrature.
    const double a = half_size[order[0]];
    SurfaceInertia out;
    if (!(a > 0))
        return out;
    const double b = half_size[order[1]] / a;
    const double c = half_size[order[2]] / a;
    // One octant over u = cos(latitude) from the c axis and turn phi from the a axis: the area
    // element bends within c ... c / b of u = 0 and within b of phi = 0.
    const std::vector<Node> heights = graded_nodes(c);
    const std::vector<Node> turns = graded_nodes(b);
    double area = 0;
    double xx = 0;
    double yy = 0;
    double zz = 0;
    for (const Node& turn : turns) {
        const double phi = 0.5 * kPi * turn.at;
        const double x = std::cos(phi);
        const double y = std::sin(phi);
        const double rim = c * c * (b * b * x * x + y * y);
        for (const Node& height : heights) {
            const double u = height.at;
            const double rest = 1 - u * u;
            const double element =
                4 * kPi * turn.weight * height.weight * std::sqrt(rest * rim + b * b * u * u);
            area += element;
            xx += element * rest * x * x;
            yy += element * rest * y * y;
            zz += element * u * u;
        }
    }
    const double square = a * a;
    out.area = area * square;
    out.moments[order[0]][order[0]] = xx * square * square;
    out.moments[order[1]][order[1]] = yy * b * b * square * square;
    out.moments[order[2]][order[2]] = zz * c * c * square * square;
    return out;
}

}  // namespace lodestone::closed_forms
