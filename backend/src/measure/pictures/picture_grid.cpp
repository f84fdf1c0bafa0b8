// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/pictures/picture_grid.h"

#include "measure/pictures/cube_views.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace lodestone::measure {
namespace {

/// Pictures show this much around the finest's bound, for larger stand-ins.
/// Taste: a larger value wastes more rays around the object.
constexpr double kFrameMargin = 1.1;
/// Pictures that are as many times as long as high show nothing.
/// Law: one row of the pixels of a square picture.
constexpr double kLongest = 576;

/// From where to where a triangle is in the row whose heights are `row` to `row` + 1: it overlaps
/// these.
std::pair<double, double> range_of_row(const std::array<glm::dvec2, 3>& triangle, double row) {
    double left = std::numeric_limits<double>::infinity();
    double right = -left;
    for (size_t i = 0; i < 3; ++i) {
        const glm::dvec2& from = triangle[i];
        const glm::dvec2& to = triangle[(i + 1) % 3];
        for (const double height : {row, row + 1, from.y}) {
            const double part = height == from.y ? 0 : (height - from.y) / (to.y - from.y);
            if (!(part >= 0 && part <= 1 && height >= row && height <= row + 1))
                continue;
            const double x = from.x + part * (to.x - from.x);
            left = std::min(left, x);
            right = std::max(right, x);
        }
    }
    return {left, right};
}

}  // namespace

PictureGrid::PictureGrid(const std::vector<glm::dvec3>& corners, const glm::dvec3& towards,
                         double pixels)
    : frame_(picture_frame(towards)) {
    glm::dvec3 low(std::numeric_limits<double>::infinity());
    glm::dvec3 high(-std::numeric_limits<double>::infinity());
    for (const glm::dvec3& corner : corners) {
        const glm::dvec3 at = corner * frame_;
        low = glm::min(low, at);
        high = glm::max(high, at);
    }
    const glm::dvec3 margin = (kFrameMargin - 1) / 2 * (high - low);
    low_ = glm::dvec2(low - margin);
    size_ = glm::dvec2(high + margin) - low_;
    const double side = std::sqrt(size_.x * size_.y / pixels);
    if (!(side > 0) || !std::isfinite(side) || std::max(size_.x, size_.y) > side * kLongest)
        return;
    front_ = high.z + margin.z + size_.x + size_.y;
    columns_ = static_cast<size_t>(std::ceil(size_.x / side));
    rows_ = static_cast<size_t>(std::ceil(size_.y / side));
}

glm::dvec3 PictureGrid::origin(size_t number, size_t parts) const {
    const size_t columns = parts * columns_;
    const size_t rows = parts * rows_;
    const double x = low_.x + (static_cast<double>(number % columns) + 0.5) * size_.x /
                                  static_cast<double>(columns);
    const double y = low_.y + (static_cast<double>(number / columns) + 0.5) * size_.y /
                                  static_cast<double>(rows);
    return frame_ * glm::dvec3(x, y, front_);
}

std::vector<uint8_t> PictureGrid::overlapped(const Mesh& mesh, size_t parts) const {
    std::vector<uint8_t> out(pixels() * parts * parts, 0);
    const glm::dvec2 count(parts * columns_, parts * rows_);
    for (const Triangle& t : mesh.triangles) {
        std::array<glm::dvec2, 3> at{};
        glm::dvec2 low(std::numeric_limits<double>::infinity());
        glm::dvec2 high(-std::numeric_limits<double>::infinity());
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec2 here =
                (flat(glm::dvec3(mesh.positions[t[corner]])) - low_) / size_ * count;
            at[static_cast<size_t>(corner)] = here;
            low = glm::min(low, here);
            high = glm::max(high, here);
        }
        // All are within the margin, but those that are not finite.
        if (!(low.x >= 0 && low.y >= 0 && high.x < count.x && high.y < count.y))
            continue;
        for (auto row = static_cast<size_t>(low.y); row <= static_cast<size_t>(high.y); ++row) {
            const auto [left, right] = range_of_row(at, static_cast<double>(row));
            if (left > right)
                continue;
            const auto begin = out.begin() + static_cast<std::ptrdiff_t>(row * parts * columns_);
            std::fill(begin + static_cast<std::ptrdiff_t>(left),
                      begin + static_cast<std::ptrdiff_t>(right) + 1, uint8_t{1});
        }
    }
    return out;
}

}  // namespace lodestone::measure
