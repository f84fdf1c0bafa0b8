// SPDX-License-Identifier: GPL-3.0-or-later
// Stand-in material: one material for a replacement, from the means over what can be seen.
#pragma once

#include "model/attributes.h"
#include "model/material.h"

namespace lodestone::approximate {

/// Means by visible area, kept within what a material may hold; "stand-in" as its name.
Material mean_material(const Attributes& attributes);

/// Of a solid that covers `opacity` of what is behind it, both its surfaces together; unchanged at 1.
Material clear_material(Material material, double opacity);

}  // namespace lodestone::approximate
