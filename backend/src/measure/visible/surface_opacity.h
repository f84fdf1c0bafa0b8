// SPDX-License-Identifier: GPL-3.0-or-later
// Opacity: how much of what is behind it a surface hides.
#pragma once

#include "ray/mesh_skin.h"

namespace lodestone::measure {

/// Mean over the surface: alpha, and of it what is not transmitted. 1 for everything opaque, and
/// for a mesh without area.
double mean_opacity(const Mesh& mesh, const ray::MeshSkin& skin, uint64_t seed);

}  // namespace lodestone::measure
