// SPDX-License-Identifier: GPL-3.0-or-later
// Environment: what is marked as wall, ground or sky, and the ground that is recognized.
#pragma once

#include "model/model.h"

#include <optional>

namespace lodestone::hierarchy {

/// By object: 1 for what is marked Environment, and for groups of nothing else.
std::vector<uint8_t> marked_environment(const Model& model, const std::vector<ObjectIndex>& order);

/// Which placement of a group is the ground of the others: of those that are not `marked` the one
/// with the largest footprint (across Z), where its role is Automatic, it is ten times wider than
/// high, nothing else has more than a quarter of its footprint, and the middles of most of the
/// others are above it. By bounds alone. Walls and skies are not recognized: a cupboard's door with
/// its knob, or a car's body around its seats, look alike.
std::optional<size_t> ground_of(const Model& model, ObjectIndex group,
                                const std::vector<uint8_t>& marked);

/// By object: 1 for what is, or is below, the ground of some group.
std::vector<uint8_t> grounds_of(const Model& model, const std::vector<ObjectIndex>& order,
                                const std::vector<uint8_t>& marked);

}  // namespace lodestone::hierarchy
