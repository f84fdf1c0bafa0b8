// SPDX-License-Identifier: GPL-3.0-or-later
// Card planes: rectangles that cross in the middle of a thing, onto which pictures of it are laid.
#pragma once

#include "model/mesh.h"

#include <vector>

namespace lodestone::cards {

/// A rectangle around all of a thing as it is seen along the rectangle's normal. Metres, the
/// thing's frame.
struct CardPlane {
    glm::dvec3 middle{0.0};
    glm::dvec3 right{1, 0, 0};  // unit
    glm::dvec3 up{0, 0, 1};     // unit
    glm::dvec2 half_size{0.0};  // along right and up

    glm::dvec3 normal() const;  // unit, towards the viewer
    bool upright() const { return up.z > 0; }
    /// The point at (x, y), each -1...1 from border to border.
    glm::dvec3 at(double x, double y) const;
};

/// Upright planes through the vertical line through `middle`, turned by equal angles, and two
/// level ones at a quarter and three quarters of the height, the last. Empty where the mesh has no
/// extent in one of these.
std::vector<CardPlane> crossed_planes(const Mesh& mesh, const glm::dvec3& middle);

}  // namespace lodestone::cards
