// SPDX-License-Identifier: GPL-3.0-or-later
// Occurrence look: the facts about one occurrence that decide how it is drawn.
#pragma once

#include "choose/cut.h"
#include "model/model.h"

#include <optional>
#include <vector>

namespace lodestone::povray {

/// Whether a node of a cut is below an Environment group, or a stand-in for a group that holds
/// Environment. `holds_environment` is with_environment() of the model.
bool is_environment(const Model& model, const choose::Cut& cut,
                    const std::vector<uint8_t>& holds_environment, uint32_t node);

/// The color without its glow of a representation that glows and is hidden from gathering rays, as
/// lights shine in its place. Nothing for all others.
std::optional<glm::dvec3> without_glow(const Model& model, const Representation& representation,
                                       RayMask hidden);

}  // namespace lodestone::povray
