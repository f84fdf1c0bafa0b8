// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/fit/outline_views.h"

#include "base/maths.h"
#include "base/parallel.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lodestone::simplify {
namespace {

/// The directions to the right and up in a view. Views from opposite sides have the same outline,
/// so these are spread over a half of the sphere (by the golden angle).
std::array<glm::vec3, 2> axes_of(int view) {
    const double z = (view + 0.5) / OutlineViews::kViews;
    const double turn = 2 * kPi * view / std::numbers::phi;
    const double across = std::sqrt(1 - z * z);
    const glm::dvec3 ahead(across * std::cos(turn), across * std::sin(turn), z);
    const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0.36, 0.48, 0.8), ahead));
    return {glm::vec3(right), glm::vec3(glm::cross(ahead, right))};
}

/// The number of pixels, 0 to kSide, whose middles lie before a coordinate; 0 for what is no
/// number.
int pixels_before(float coordinate) {
    constexpr auto kEnd = static_cast<float>(OutlineViews::kSide);
    return static_cast<int>(std::min(std::max(0.0f, coordinate + 0.5f), kEnd));
}

/// Sets the pixels whose middles lie in a triangle.
void fill(std::array<glm::vec2, 3> corners, uint32_t triangle, std::vector<uint32_t>& pixels) {
    // Most triangles of an original are smaller than a pixel.
    const auto [left, right] = std::minmax({corners[0].x, corners[1].x, corners[2].x});
    const auto [bottom, top] = std::minmax({corners[0].y, corners[1].y, corners[2].y});
    const int end = pixels_before(top);
    int row = pixels_before(bottom);
    if (row >= end || pixels_before(left) >= pixels_before(right))
        return;
    std::sort(corners.begin(), corners.end(),
              [](const glm::vec2& a, const glm::vec2& b) { return a.y < b.y; });
    const auto& [low, middle, high] = corners;
    const auto at = [](const glm::vec2& a, const glm::vec2& b, float y) {
        return b.y > a.y ? a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)) : a.x;
    };
    for (; row < end; ++row) {
        const float y = static_cast<float>(row) + 0.5f;
        const float a = at(low, high, y);
        const float b = y < middle.y ? at(low, middle, y) : at(middle, high, y);
        const int first = pixels_before(std::min(a, b));
        const int last = pixels_before(std::max(a, b));
        const auto of_row = pixels.begin() + std::ptrdiff_t{row} * OutlineViews::kSide;
        std::fill(of_row + first, of_row + std::max(first, last), triangle);
    }
}

}  // namespace

OutlineViews::OutlineViews(std::span<const glm::vec3> positions,
                           std::span<const Triangle> triangles) {
    float farthest = 0;
    for (const glm::vec3& position : positions) {
        const float square = glm::dot(position, position);
        farthest = std::isfinite(square) ? std::max(farthest, square) : farthest;
    }
    // A margin at each side: levels may be a little larger.
    zoom_ = farthest > 0 ? 0.47f * static_cast<float>(kSide) / std::sqrt(farthest) : 1;
    parallel_for(kViews, [&](size_t view) {
        covered_[view] = draw(static_cast<int>(view), positions, triangles);
    });
}

std::vector<uint32_t> OutlineViews::draw(int view, std::span<const glm::vec3> positions,
                                         std::span<const Triangle> triangles) const {
    const auto [right, up] = axes_of(view);
    std::vector<glm::vec2> places(positions.size());
    for (size_t v = 0; v < places.size(); ++v)
        places[v] = glm::vec2(glm::dot(positions[v], right), glm::dot(positions[v], up)) * zoom_ +
                    0.5f * static_cast<float>(kSide);
    std::vector<uint32_t> pixels(static_cast<size_t>(kSide) * kSide, kNone);
    for (uint32_t t = 0; t < triangles.size(); ++t) {
        const Triangle& c = triangles[t];
        fill({places[c.x], places[c.y], places[c.z]}, t, pixels);
    }
    return pixels;
}

std::vector<OutlineViews::OddPixel> OutlineViews::odd_pixels(
    std::span<const glm::vec3> positions, std::span<const Triangle> triangles) const {
    std::array<std::vector<OddPixel>, kViews> odd;
    parallel_for(kViews, [&](size_t view) {
        const std::vector<uint32_t> drawn = draw(static_cast<int>(view), positions, triangles);
        const std::vector<uint32_t>& covered = covered_[view];
        for (size_t i = 0; i < drawn.size(); ++i) {
            if ((drawn[i] == kNone) != (covered[i] == kNone))
                odd[view].push_back({covered[i], drawn[i]});
        }
    });
    std::vector<OddPixel> out;
    for (const std::vector<OddPixel>& some : odd)
        out.insert(out.end(), some.begin(), some.end());
    return out;
}

}  // namespace lodestone::simplify
