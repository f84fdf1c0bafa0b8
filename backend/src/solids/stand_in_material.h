// SPDX-License-Identifier: GPL-3.0-or-later
// Stand-in material: one material for a replacement, from the means over what can be seen.
#pragma once

#include "model/attributes.h"
#include "model/material.h"

namespace lodestone::solids {

/// Means by visible area, kept within what a material may hold; "stand-in" as its name.
Material mean_material(const Attributes& attributes);

/// Of a solid that covers `opacity` of what is behind it, both its surfaces together; unchanged
/// at 1.
Material clear_material(Material material, double opacity);

/// Scatters `factor` times as much light, by color, kept within 0...1; of a textured color all
/// channels alike, by the mean. What glows, and highlights, stay.
void brighten(Material& material, const glm::dvec3& factor);

}  // namespace lodestone::solids
