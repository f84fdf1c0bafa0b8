// SPDX-License-Identifier: GPL-3.0-or-later
// Level rings: the outline of where a grid of numbers is at least a level (marching squares).
#pragma once

#include <glm/vec2.hpp>

#include <cstdint>
#include <vector>

namespace lodestone {

/// A closed outline. What is inside lies to its left where y points up: its area is positive around
/// an island and negative around a hole.
using Ring = std::vector<glm::dvec2>;

/// The area inside a ring by the sign of its direction.
double signed_area(const Ring& ring);

/// The numbers of a picture's texels, interpolated between their centers. A texel is a square of
/// side 1; x runs along a row, y up from the lowest row.
class LevelGrid {
public:
    /// The numbers are finite, the upper row first. The border of a grid that `repeats` is between
    /// its texels and those of the other side; else it is as its own texels.
    LevelGrid(int width, int height, const std::vector<float>& numbers, bool repeats);

    int width() const { return width_; }
    int height() const { return height_; }

    /// The area where the number is at least a level of `kLeast` to 1 - `kLeast`, of the texels
    /// that `counts` (one for each texel, upper row first) does not leave out.
    double area(double level, const std::vector<uint8_t>& counts) const;
    /// The level whose area is nearest to `area`, found by halving.
    double level_of(double area, const std::vector<uint8_t>& counts) const;
    /// The outlines at a level: closed along the border, whose points are exactly on it. No point
    /// follows an equal one. Empty where there are more than `most` points in all: noise.
    std::vector<Ring> rings(double level, size_t most, bool& too_many) const;

    /// Law: half a step of 8 bits and more; beyond there is no outline to find.
    static constexpr double kLeast = 1.0 / 64;

private:
    struct GridCell {
        float values[4];
        double wide;
        double high;
    };
    size_t at(int column, int row) const {
        return static_cast<size_t>(row) * static_cast<size_t>(columns_) +
               static_cast<size_t>(column);
    }
    glm::dvec2 place(int column, int row) const { return {xs_[column], ys_[row]}; }
    std::vector<GridCell> mixed_cells(const std::vector<uint8_t>& counts, double& full) const;
    bool inside(int column, int row, double level) const {
        return values_[at(column, row)] >= level;
    }
    int32_t edge(int column, int row, int side) const;
    glm::dvec2 crossing(int32_t edge, double level) const;

    int width_;
    int height_;
    // The nodes are the centers of the texels, those on the border, and those outside of it, where
    // nothing is.
    int columns_;
    int rows_;
    std::vector<double> xs_;
    std::vector<double> ys_;
    std::vector<float> values_;
};

}  // namespace lodestone
