// SPDX-License-Identifier: GPL-3.0-or-later
#include "cards/card_planes.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <limits>
#include <numbers>

namespace lodestone::cards {
namespace {

/// Fits the rectangle to all corners of the mesh's triangles; the plane stays.
void fit_to(const Mesh& mesh, CardPlane& plane) {
    glm::dvec2 low(std::numeric_limits<double>::infinity());
    glm::dvec2 high(-std::numeric_limits<double>::infinity());
    for (const Triangle& triangle : mesh.triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec3 arm = glm::dvec3(mesh.positions[triangle[corner]]) - plane.middle;
            const glm::dvec2 at(glm::dot(arm, plane.right), glm::dot(arm, plane.up));
            if (!std::isfinite(at.x + at.y))
                continue;
            low = glm::min(low, at);
            high = glm::max(high, at);
        }
    }
    plane.half_size = 0.5 * (high - low);
    const glm::dvec2 off = 0.5 * (low + high);
    plane.middle += off.x * plane.right + off.y * plane.up;
}

}  // namespace

glm::dvec3 CardPlane::normal() const {
    return glm::cross(right, up);
}

glm::dvec3 CardPlane::at(double x, double y) const {
    return middle + x * half_size.x * right + y * half_size.y * up;
}

std::vector<CardPlane> crossed_planes(const Mesh& mesh, const glm::dvec3& middle) {
    // Taste: with two, crowns are a third farther off in pictures; more cost triangles.
    constexpr int kUpright = 3;
    // Taste: with one, crowns cover a tenth too little from 45 degrees above, and too much from
    // straight above; more cost triangles.
    constexpr int kLevel = 2;
    std::vector<CardPlane> out;
    for (int i = 0; i < kUpright; ++i) {
        const double turn = std::numbers::pi * i / kUpright;
        out.push_back({middle, {std::cos(turn), std::sin(turn), 0}, {0, 0, 1}, {}});
    }
    Box3 box;
    for (const Triangle& triangle : mesh.triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec3 at(mesh.positions[triangle[corner]]);
            if (std::isfinite(at.x + at.y + at.z))
                box.add(at);
        }
    }
    for (int i = 0; i < kLevel; ++i) {
        const double height = std::lerp(box.low.z, box.high.z, (i + 0.5) / kLevel);
        out.push_back({{middle.x, middle.y, height}, {1, 0, 0}, {0, 1, 0}, {}});
    }
    for (CardPlane& plane : out) {
        fit_to(mesh, plane);
        const double area = plane.half_size.x * plane.half_size.y;
        if (!(area > 0) || !std::isfinite(area))
            return {};
    }
    return out;
}

}  // namespace lodestone::cards
