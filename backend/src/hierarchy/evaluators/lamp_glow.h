// SPDX-License-Identifier: GPL-3.0-or-later
// Glow: levels of what has lamps in it, and how bright they are.
#pragma once

#include "base/job.h"
#include "model/material.h"
#include "model/mesh.h"

#include <span>
#include <vector>

namespace lodestone::hierarchy {

/// Whether a material, or what it is mixed with, emits any light.
bool emits(const Material& material);
/// Emits `factor` times as much, by color.
void emit_more(Material& material, const glm::dvec3& factor);
/// What is left of a material where nothing is lit.
Material unlit(const Material& material);

/// simplify::simplify_chain(), but loose parts that glow in the midst of others (a bulb in its
/// globe) are simplified by themselves, to a twelfth of the triangles or more: as small as they are
/// they would vanish first, and with them what lights the thing.
std::vector<Mesh> simplify_with_lamps(const Mesh& mesh, std::span<const Material> materials,
                                      std::span<const size_t> targets, const Job& job);

}  // namespace lodestone::hierarchy
