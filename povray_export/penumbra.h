// SPDX-License-Identifier: GPL-3.0-or-later
// Penumbra: how wide a sun's soft shadows can be in a picture. Where no pixel could tell, they are
// drawn sharp: lights are approximated too (dissertation 5.4.1).
#pragma once

#include "model/view.h"

#include <span>

namespace lodestone::povray {

/// The widest penumbra in pixels that a sun gives in a view of these occluders (world frame): what
/// stands above the lowest point of all of them by h throws its shadow at most h / sin(elevation)
/// far, seen no nearer than its bound less that way. 0 for suns without an angle and without
/// occluders.
double widest_penumbra(const Light& sun, const View& view, std::span<const Bound> occluders);

}  // namespace lodestone::povray
