// SPDX-License-Identifier: GPL-3.0-or-later
// Plane ranges: where triangles of the plane are.
#pragma once

#include "base/maths.h"

#include <glm/vec2.hpp>

namespace lodestone::povray {

struct PlaneBox {
    glm::dvec2 low;
    glm::dvec2 high;
};
PlaneBox box_of(const glm::dvec2 (&at)[3]);

/// A range of one coordinate; `low` above `high`: it is empty.
struct PlaneRange {
    double low = kInfinity;
    double high = -kInfinity;
};

/// The extent along the other axis of the part of a triangle that lies between two heights.
PlaneRange range_between(const glm::dvec2 (&at)[3], double bottom, double top);

/// The part of a line's length, from `from` to `to`, that is inside a triangle.
PlaneRange range_inside(const glm::dvec2& from, const glm::dvec2& to, const glm::dvec2 (&at)[3]);

}  // namespace lodestone::povray
