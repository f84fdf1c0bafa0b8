// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/level_rings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace lodestone {
namespace {

/// Positions along an axis: the outside and the border of either end share a place.
std::vector<double> places(int count) {
    std::vector<double> out{0, 0};
    for (int i = 0; i < count; ++i)
        out.push_back(i + 0.5);
    out.push_back(count);
    out.push_back(count);
    return out;
}

/// The part of a cell's side of length 1 from a node that is inside to where the level is.
double reach(double inside, double outside, double level) {
    return (inside - level) / (inside - outside);
}

/// The share of a cell (its corners in order around it) where the number is at least the level.
double covered(const float (&v)[4], double level) {
    int count = 0;
    double sum = 0;
    for (const float value : v) {
        count += value >= level ? 1 : 0;
        sum += static_cast<double>(value);
    }
    const auto corner = [&](int k, bool of_outside) {
        const double before = static_cast<double>(v[(k + 3) % 4]);
        const double after = static_cast<double>(v[(k + 1) % 4]);
        const double own = static_cast<double>(v[k]);
        return of_outside ? (1 - reach(before, own, level)) * (1 - reach(after, own, level)) / 2
                          : reach(own, before, level) * reach(own, after, level) / 2;
    };
    if (count == 0 || count == 4)
        return count == 4 ? 1 : 0;
    const auto is_inside = [&](int k) { return static_cast<double>(v[k % 4]) >= level; };
    const bool saddle = count == 2 && is_inside(0) == is_inside(2);
    if (count == 2 && !saddle) {
        int first = 0;
        while (!is_inside(first) || !is_inside(first + 1))
            ++first;
        const auto value = [&](int k) { return static_cast<double>(v[k % 4]); };
        return (reach(value(first), value(first + 3), level) +
                reach(value(first + 1), value(first + 2), level)) /
               2;
    }
    const bool of_outside = count == 3 || (saddle && sum / 4 >= level);
    double corners = 0;
    for (int k = 0; k < 4; ++k) {
        if (is_inside(k) != of_outside)
            corners += corner(k, of_outside);
    }
    return of_outside ? 1 - corners : corners;
}

}  // namespace

double signed_area(const Ring& ring) {
    double twice = 0;
    for (size_t i = 0; i < ring.size(); ++i) {
        const glm::dvec2& a = ring[i];
        const glm::dvec2& b = ring[i + 1 < ring.size() ? i + 1 : 0];
        twice += a.x * b.y - a.y * b.x;
    }
    return twice / 2;
}

LevelGrid::LevelGrid(int width, int height, const std::vector<float>& numbers, bool repeats)
    : width_(width),
      height_(height),
      columns_(width + 4),
      rows_(height + 4),
      xs_(places(width)),
      ys_(places(height)),
      values_(static_cast<size_t>(columns_) * static_cast<size_t>(rows_), -1.0f) {
    const auto texel = [&](int x, int y) {
        return numbers[static_cast<size_t>(height - 1 - y) * static_cast<size_t>(width) +
                       static_cast<size_t>(x)];
    };
    // A node on the border is the mean of the texels on both its sides.
    const auto sides = [&](int node, int count) -> std::array<int, 2> {
        if (node == 1)
            return {0, repeats ? count - 1 : 0};
        if (node == count + 2)
            return {count - 1, repeats ? 0 : count - 1};
        return {node - 2, node - 2};
    };
    for (int row = 1; row + 1 < rows_; ++row) {
        const std::array<int, 2> y = sides(row, height);
        for (int column = 1; column + 1 < columns_; ++column) {
            const std::array<int, 2> x = sides(column, width);
            values_[at(column, row)] =
                (texel(x[0], y[0]) + texel(x[1], y[0]) + texel(x[0], y[1]) + texel(x[1], y[1])) / 4;
        }
    }
}

std::vector<LevelGrid::GridCell> LevelGrid::mixed_cells(const std::vector<uint8_t>& counts,
                                                        double& full) const {
    std::vector<GridCell> out;
    full = 0;
    for (int row = 1; row + 2 < rows_; ++row) {
        const size_t texel_row = static_cast<size_t>(height_ - 1 - std::min(row - 1, height_ - 1));
        for (int column = 1; column + 2 < columns_; ++column) {
            const auto texel_column = static_cast<size_t>(std::min(column - 1, width_ - 1));
            if (counts[texel_row * static_cast<size_t>(width_) + texel_column] == 0)
                continue;
            GridCell cell{{values_[at(column, row)], values_[at(column + 1, row)],
                           values_[at(column + 1, row + 1)], values_[at(column, row + 1)]},
                          xs_[column + 1] - xs_[column],
                          ys_[row + 1] - ys_[row]};
            const auto [least, most] = std::minmax_element(cell.values, cell.values + 4);
            if (*least >= 1 - kLeast)
                full += cell.wide * cell.high;
            else if (*most >= kLeast)
                out.push_back(cell);
        }
    }
    return out;
}

double LevelGrid::area(double level, const std::vector<uint8_t>& counts) const {
    double sum = 0;
    for (const GridCell& cell : mixed_cells(counts, sum))
        sum += cell.wide * cell.high * covered(cell.values, level);
    return sum;
}

double LevelGrid::level_of(double area, const std::vector<uint8_t>& counts) const {
    // The halvings of the range of levels.
    // Law: 2^-10 is finer than a step of 8 bits.
    constexpr int kSteps = 10;
    double full = 0;
    const std::vector<GridCell> cells = mixed_cells(counts, full);
    double low = kLeast;
    double high = 1 - kLeast;
    for (int step = 0; step < kSteps; ++step) {
        const double level = (low + high) / 2;
        double sum = full;
        for (const GridCell& cell : cells)
            sum += cell.wide * cell.high * covered(cell.values, level);
        (sum > area ? low : high) = level;
    }
    return (low + high) / 2;
}

/// The edges of a cell, numbered in order around it from the lower one.
int32_t LevelGrid::edge(int column, int row, int side) const {
    const int right = side == 1 ? 1 : 0;
    const int up = side == 2 ? 1 : 0;
    return static_cast<int32_t>(2 * at(column + right, row + up)) + (side % 2);
}

glm::dvec2 LevelGrid::crossing(int32_t edge, double level) const {
    const int node = edge / 2;
    const int column = node % columns_;
    const int row = node / columns_;
    const bool upright = edge % 2 != 0;
    const int column2 = column + (upright ? 0 : 1);
    const int row2 = row + (upright ? 1 : 0);
    const auto from = static_cast<double>(values_[at(column, row)]);
    const auto to = static_cast<double>(values_[at(column2, row2)]);
    const double part = (level - from) / (to - from);
    return place(column, row) + part * (place(column2, row2) - place(column, row));
}

std::vector<Ring> LevelGrid::rings(double level, size_t most, bool& too_many) const {
    constexpr int32_t kNone = -1;  // Law: no edge has this number.
    too_many = false;
    std::vector<int32_t> next(2 * values_.size(), kNone);
    std::vector<int32_t> starts;
    for (int row = 0; row + 1 < rows_; ++row) {
        for (int column = 0; column + 1 < columns_; ++column) {
            const bool in[4] = {inside(column, row, level), inside(column + 1, row, level),
                                inside(column + 1, row + 1, level), inside(column, row + 1, level)};
            const int count = in[0] + in[1] + in[2] + in[3];
            if (count == 0 || count == 4)
                continue;
            const double sum = static_cast<double>(values_[at(column, row)]) +
                               static_cast<double>(values_[at(column + 1, row)]) +
                               static_cast<double>(values_[at(column + 1, row + 1)]) +
                               static_cast<double>(values_[at(column, row + 1)]);
            // Where two opposite corners are inside they are joined if the middle is.
            const bool apart = count == 2 && in[0] == in[2] && sum / 4 < level;
            for (int side = 0; side < 4; ++side) {
                if (!in[side] || in[(side + 1) % 4])
                    continue;
                int enters = apart ? (side + 3) % 4 : (side + 1) % 4;
                while (in[enters] || !in[(enters + 1) % 4])
                    enters = (enters + 1) % 4;
                const int32_t from = edge(column, row, side);
                next[static_cast<size_t>(from)] = edge(column, row, enters);
                starts.push_back(from);
            }
        }
        if (starts.size() > most) {
            too_many = true;
            return {};
        }
    }
    std::vector<Ring> out;
    for (const int32_t start : starts) {
        if (next[static_cast<size_t>(start)] == kNone)
            continue;
        Ring ring;
        for (int32_t at = start; next[static_cast<size_t>(at)] != kNone;) {
            const glm::dvec2 point = crossing(at, level);
            if (ring.empty() || ring.back() != point)
                ring.push_back(point);
            at = std::exchange(next[static_cast<size_t>(at)], kNone);
        }
        while (ring.size() > 1 && ring.back() == ring.front())
            ring.pop_back();
        if (ring.size() > 2)
            out.push_back(std::move(ring));
    }
    return out;
}

}  // namespace lodestone
