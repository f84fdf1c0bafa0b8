// SPDX-License-Identifier: GPL-3.0-or-later
// Lit cells: the parts of a picture in which lamps may matter, which alone are looked through.
#pragma once

#include "light/lit_points.h"

namespace lodestone::light {

/// By cell of a grid whose points know their other light: whether lamps, if nothing hid them, would
/// matter at a point of the cell or of one that touches it; where a cell has no point; and where
/// things near a lamp may be (within the distance at which it is worth a step of an 8-bit display
/// in the light of `sky` alone), which points may have missed. Any number of threads gives the same
/// result.
std::vector<uint8_t> cells_with_lamps(std::span<const Light> lights, const View& view,
                                      const LitGrid& grid, const glm::dvec3& sky,
                                      double pixel_error, const Job& job);

}  // namespace lodestone::light
