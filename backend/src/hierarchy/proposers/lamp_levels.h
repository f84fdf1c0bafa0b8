// SPDX-License-Identifier: GPL-3.0-or-later
// Lamp levels: simpler meshes of what has lamps in it.
#pragma once

#include "base/job.h"
#include "model/material.h"
#include "model/mesh.h"

#include <span>
#include <vector>

namespace lodestone::hierarchy {

/// Whether something of a mesh is a lamp.
bool has_lamps(const Mesh& mesh, std::span<const Material> materials);

/// Levels as simplify::simplify_chain() makes them, but loose parts that glow in the midst of
/// others (a bulb in its globe) are simplified by themselves, to a twelfth of the triangles or
/// more: as small as they are they would vanish first, and with them what lights the thing.
std::vector<Mesh> simplify_with_lamps(const Mesh& mesh, std::span<const Material> materials,
                                      std::span<const size_t> targets, const Job& job);

}  // namespace lodestone::hierarchy
