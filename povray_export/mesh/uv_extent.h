// SPDX-License-Identifier: GPL-3.0-or-later
// UV extent: how far texture coordinates reach over a surface.
#pragma once

#include "model/mesh.h"

#include <span>

namespace lodestone::povray {

/// The metres that a step of 1 in texture coordinates covers of a triangle, where it covers most.
/// Infinite where all of the triangle shows one place or one line of the picture.
double metres_of_uv(const Mesh& mesh, size_t triangle);

/// The most that metres_of_uv() is over a part of the triangles' area, which leaves `spared` of it
/// out; 0 where they have no area.
double metres_of_uv(const Mesh& mesh, std::span<const uint32_t> triangles, double spared);

}  // namespace lodestone::povray
