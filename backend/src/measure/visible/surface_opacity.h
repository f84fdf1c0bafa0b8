// SPDX-License-Identifier: GPL-3.0-or-later
// Surface opacity: how much of what is behind it a surface hides.
#pragma once

#include "ray/mesh_skin.h"

namespace lodestone::measure {

/// The mean opacity over the surface, 0...1: its alpha times the share that is not transmitted. 1
/// for an opaque mesh, and for a mesh without area.
double mean_opacity(const Mesh& mesh, const ray::MeshSkin& skin, uint64_t seed);

}  // namespace lodestone::measure
