// SPDX-License-Identifier: GPL-3.0-or-later
// Stand-in material: one material for a replacement, from the means over the visible surface.
#pragma once

#include "model/attributes.h"
#include "model/material.h"

namespace lodestone::solids {

/// The means by visible area, kept within the limits of a material; its name is "stand-in".
Material mean_material(const Attributes& attributes);

/// The material of a solid that covers `opacity` of what is behind it, both its surfaces together;
/// unchanged at 1.
Material clear_material(Material material, double opacity);

/// Makes the material scatter `factor` times as much light, by color, kept within 0...1; a textured
/// color is changed in all channels alike, by the mean. Emitted light and highlights stay.
void brighten(Material& material, const glm::dvec3& factor);

}  // namespace lodestone::solids
