// SPDX-License-Identifier: GPL-3.0-or-later
// Clear materials: which materials let light through, and their part that rays to lights meet.
#pragma once

#include "model/material.h"

namespace lodestone::light {

/// Whether light goes through some or all of a material.
bool lets_light_through(const Material& material);

/// The part of a material that rays to lights meet, with what it transmits as a part of its alpha:
/// rays go through glass. It has no other pictures, which would be decoded.
Material clear_material(const Material& material);

}  // namespace lodestone::light
