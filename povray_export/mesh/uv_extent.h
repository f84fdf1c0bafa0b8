// SPDX-License-Identifier: GPL-3.0-or-later
// UV extent: how far texture coordinates reach over a surface.
#pragma once

#include "model/mesh.h"

namespace lodestone::povray {

/// The metres that a step of 1 in texture coordinates covers of a triangle, where it covers most.
/// Infinite where all of the triangle shows one place or one line of the picture.
double metres_of_uv(const Mesh& mesh, size_t triangle);

}  // namespace lodestone::povray
