// SPDX-License-Identifier: GPL-3.0-or-later
// PictureGrid: the pixels of an orthographic picture around a mesh, and the parts of pixels.
#pragma once

#include "model/mesh.h"

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

#include <cstdint>
#include <vector>

namespace lodestone::measure {

/// Pixels are numbered row by row. Divided by `parts` along both sides they are a grid of as many
/// times as many columns and rows, whose numbers go row by row, too.
class PictureGrid {
public:
    /// About so many pixels around the corners of a mesh, seen from the unit direction `towards`.
    /// There are none where that is a line or nothing. Throws nothing but std::bad_alloc.
    PictureGrid(const std::vector<glm::dvec3>& corners, const glm::dvec3& towards, double pixels);

    size_t columns() const { return columns_; }
    size_t pixels() const { return columns_ * rows_; }
    /// The middle of a pixel or part, before all that the picture shows: a ray begins there and goes
    /// in the opposite of `towards`.
    glm::dvec3 origin(size_t number, size_t parts = 1) const;
    /// By part of a pixel, 1: it overlaps the rectangle around a triangle of the mesh.
    std::vector<uint8_t> overlapped(const Mesh& mesh, size_t parts) const;

private:
    glm::dvec2 flat(const glm::dvec3& point) const {
        const glm::dvec3 own = point * frame_;
        return {own.x, own.y};
    }

    glm::dmat3 frame_;  // right, up, towards
    glm::dvec2 low_{0.0};
    glm::dvec2 size_{0.0};
    double front_ = 0;  // along `towards`
    size_t columns_ = 0;
    size_t rows_ = 0;
};

}  // namespace lodestone::measure
