// SPDX-License-Identifier: GPL-3.0-or-later
// Penumbra: how wide soft shadows can be in a picture. Where no pixel shows the difference they are
// drawn sharp, and where few pixels do with fewer rays: lights are approximated, too (dissertation
// 5.4.1).
#pragma once

#include "model/view.h"

#include <span>

namespace lodestone::light {

/// The narrowest penumbrae that show, side by side in one, for which one ray stands.
/// Taste: in ravenbridge_mansion 3 x 3 rays of a sun for 8 pixels look like 5 x 5; a larger value
/// shows steps.
inline constexpr double kPenumbraeOfRay = 3;

/// The share of points whose shadows may have steps, for their penumbrae are wider than others.
/// Taste: a larger value draws more shadows sharp.
inline constexpr double kSteppedShare = 0.01;

/// The widest penumbra, in pixels, that a light gives in a view of these occluders (world frame).
/// Sun: a thing that rises h above the lowest point of all throws its shadow at most h /
/// sin(elevation) far, seen no nearer than its bound minus that distance. Point and spot: twice
/// their size (by occluders a third of the way from the light), seen no nearer than where they
/// still light; areas in the same way, with their diagonal as the size. 0 without a size and
/// without occluders.
double widest_penumbra(const Light& light, const View& view, std::span<const Bound> occluders);

/// The widest penumbra, in pixels, that a lamp gives at a point: twice its size, seen there.
double penumbra_at(const Light& lamp, const View& view, const glm::dvec3& point);

}  // namespace lodestone::light
