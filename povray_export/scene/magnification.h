// SPDX-License-Identifier: GPL-3.0-or-later
// Magnification: small scenes are written larger, with the camera and lights, for POV-Ray takes
// points nearer than a millimetre for one.
#pragma once

#include "model/view.h"

#include <span>

namespace lodestone::povray {

/// The distance, in POV-Ray's units, nearer than which no shadow begins and no ray goes on.
/// Law: POV-Ray 3.7 has it in its sources, in its own units.
inline constexpr double kTolerance = 1e-3;

/// The factor by which a scene is written larger: the least power of two (exact: no digit changes)
/// that makes the tolerance smaller than a pixel at each of these bounds (world frame): at its
/// center, or at its radius where the eye is nearer than that. It is 1 for scenes of everyday size,
/// and less than asked for where the whole would become larger than POV-Ray's numbers bear.
double magnification(const View& view, std::span<const Bound> bounds);

/// The same picture of a world that is `times` as large. Powers of lights grow with its square.
Camera magnified(Camera camera, double times);
Light magnified(Light light, double times);
Affine magnified(Affine transform, double times);
Bound magnified(Bound bound, double times);

}  // namespace lodestone::povray
