// SPDX-License-Identifier: GPL-3.0-or-later
// UV projection: texture coordinates made from positions.
#pragma once

#include "base/maths.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>

namespace lodestone {

enum class UvProjection : uint8_t {
    Flat = 0,    // x and y
    Box = 1,     // the face of a cube that the triangle faces most
    Sphere = 2,  // longitude and latitude around (1/2, 1/2, 1/2)
    Tube = 3,    // longitude around that point's z axis, and z
};

/// The texture coordinates of a triangle's corners, from points in the space of the picture and the
/// triangle's normal (of any length) in the object's. Triangles across the seam of Sphere and Tube
/// continue beyond 1, so that a repeated picture has no seam. source: Blender's image texture node,
/// as Cycles draws it; Box without blending
std::array<glm::dvec2, 3> project_uvs(UvProjection projection,
                                      const std::array<glm::dvec3, 3>& points,
                                      const glm::dvec3& normal);

}  // namespace lodestone
