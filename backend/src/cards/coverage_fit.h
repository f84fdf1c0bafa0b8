// SPDX-License-Identifier: GPL-3.0-or-later
// CoverageFit: how much crossed cards cover, brought to what a thing covers from all sides.
#pragma once

#include "cards/card_picture.h"

namespace lodestone::cards {

/// Changes the shares of a picture's texels where that makes the cards together cover the same
/// parts of orthographic pictures from above the horizon as the mesh in `scene`. Cards that are
/// looked at obliquely hide each other, and leave out what lies beside them. Texels that are half
/// covered come to be there, or not to be, first. The bits are the same on any number of threads.
void fit_coverage(CardPicture& picture, std::span<const CardPlane> planes,
                  const ray::MeshScene& scene, uint64_t seed, const Job& job);

}  // namespace lodestone::cards
