// SPDX-License-Identifier: GPL-3.0-or-later
// Lamp materials: what emits light, and how much of it.
#pragma once

#include "model/material.h"

namespace lodestone::hierarchy {

/// Whether a material, or what it is mixed with, emits any light.
bool emits(const Material& material);
/// Emits `factor` times as much, by color.
void emit_more(Material& material, const glm::dvec3& factor);
/// A material as it is where nothing lights it: what it emits is left.
Material unlit(const Material& material);

}  // namespace lodestone::hierarchy
