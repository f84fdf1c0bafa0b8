// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/lit_cells.h"

#include "base/maths.h"
#include "base/parallel.h"
#include "light/light_arrival.h"

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestone::light {
namespace {

/// The distance from a lamp within which it is worth a step of a display to a white surface.
double reach_of(const Light& lamp, const glm::dvec3& sky) {
    const double step = display_step(std::max({sky.x, sky.y, sky.z, 0.0}));
    const glm::dvec3 energy = energy_of(lamp);
    const double sent = std::max({energy.x, energy.y, energy.z}) / (4 * kPi);
    const double strength = lamp.kind == LightKind::Area ? sent : sent / kPi;
    return std::sqrt(strength / step) + extent_of(lamp);
}

/// Marks the cells in which a ball may be seen.
class BallCells {
public:
    BallCells(const View& view, LitGrid const& grid, std::vector<uint8_t>& cells)
        : camera_(view.camera),
          rows_(grid.rows),
          columns_(grid.columns),
          cells_(cells),
          frame_(
              glm::inverse(glm::dmat3(view.camera.direction, view.camera.right, view.camera.up))) {}

    void mark(const glm::dvec3& center, double radius) {
        const glm::dvec3 at = frame_ * (center - camera_.position);
        glm::dvec3 reach;
        for (int i = 0; i < 3; ++i)
            reach[i] = radius * glm::length(glm::transpose(frame_)[i]);
        double nearest = at.x - reach.x;
        double farthest = at.x + reach.x;
        if (farthest < 0)
            return;
        if (camera_.orthographic)
            nearest = farthest = 1;
        if (!(nearest > 0) || !finite(at) || !finite(reach)) {
            std::fill(cells_.begin(), cells_.end(), uint8_t{1});
            return;
        }
        const auto range = [&](double middle, double half, size_t count) {
            const double low = std::min((middle - half) / nearest, (middle - half) / farthest);
            const double high = std::max((middle + half) / nearest, (middle + half) / farthest);
            const auto cell = [&](double part) {
                return std::clamp(std::floor((part + 0.5) * static_cast<double>(count)), -1.0,
                                  static_cast<double>(count));
            };
            return std::pair<double, double>(cell(low), cell(high));
        };
        const auto [left, right] = range(at.y, reach.y, columns_);
        const auto [top, bottom] = range(-at.z, reach.z, rows_);
        for (double row = std::max(0.0, top); row <= bottom && row < static_cast<double>(rows_);
             ++row) {
            for (double column = std::max(0.0, left);
                 column <= right && column < static_cast<double>(columns_); ++column)
                cells_[static_cast<size_t>(row) * columns_ + static_cast<size_t>(column)] = 1;
        }
    }

private:
    const Camera& camera_;
    size_t rows_;
    size_t columns_;
    std::vector<uint8_t>& cells_;
    glm::dmat3 frame_;
};

}  // namespace

std::vector<uint8_t> cells_with_lamps(std::span<const Light> lights, const View& view,
                                      const LitGrid& grid, const glm::dvec3& sky,
                                      double pixel_error, const Job& job) {
    std::vector<const Light*> lamps;
    for (const Light& light : lights) {
        if (is_lamp(light))
            lamps.push_back(&light);
    }
    const size_t cells = grid.rows * grid.columns;
    std::vector<uint8_t> matter(cells, 0);
    parallel_for(grid.rows, [&](size_t row) {
        job.check();
        for (size_t cell = row * grid.columns; cell < (row + 1) * grid.columns; ++cell) {
            bool found = grid.first[cell] == grid.first[cell + 1];
            for (uint32_t i = grid.first[cell]; i < grid.first[cell + 1] && !found; ++i)
                found = may_matter(lamps, grid.points[i], pixel_error);
            matter[cell] = found ? 1 : 0;
        }
    });
    std::vector<uint8_t> out(cells, 0);
    for (size_t cell = 0; cell < cells; ++cell) {
        if (matter[cell] == 0)
            continue;
        for (const size_t there : around(grid, cell / grid.columns, cell % grid.columns))
            out[there] = 1;
    }
    BallCells balls(view, grid, out);
    for (const Light* lamp : lamps)
        balls.mark(lamp->position, reach_of(*lamp, sky));
    return out;
}

}  // namespace lodestone::light
