// SPDX-License-Identifier: GPL-3.0-or-later
// CardLight: the colors of crossed cards, brought to the light that a thing shows.
#pragma once

#include "cards/card_picture.h"

namespace lodestone::cards {

/// Multiplies the colors of all upright cards, and those of all level ones, by a factor for each
/// channel, so that they show about as bright a picture as the mesh in `scene` and `skin` from
/// above the horizon, under suns all around above it: level cards face a high sun and upright ones
/// a low one, as leaves do not. Colors may become larger than 1. The bits are the same on any number of
/// threads.
void match_light(CardPicture& picture, std::span<const CardPlane> planes, const Mesh& mesh,
                 const ray::MeshScene& scene, const ray::MeshSkin& skin, uint64_t seed,
                 const Job& job);

}  // namespace lodestone::cards
