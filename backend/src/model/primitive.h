// SPDX-License-Identifier: GPL-3.0-or-later
// Primitives: exact box and ellipsoid, and their tessellation for consumers that know only
// triangles.
#pragma once

#include "model/mesh.h"

namespace lodestone {

/// A box |x_i| <= 1 or the unit sphere, scaled by half_size along its axes, turned, moved.
struct Primitive {
    glm::dvec3 center{0.0};
    glm::dmat3 axes{1.0};       // orthonormal, right-handed columns
    glm::dvec3 half_size{1.0};  // metres, > 0
};

/// The unit primitive -> the object's frame.
Affine frame_of(const Primitive& primitive);
Bound bound_of_box(const Primitive& box);
Bound bound_of_ellipsoid(const Primitive& ellipsoid);

/// 12 triangles, 24 vertices with normals.
Mesh tessellate_box(const Primitive& box);
/// 20 * 4^subdivisions triangles with exact normals; vertices lie on the ellipsoid.
Mesh tessellate_ellipsoid(const Primitive& ellipsoid, int subdivisions = 2);

}  // namespace lodestone
