// SPDX-License-Identifier: GPL-3.0-or-later
// Magnification: small scenes are written larger, with the camera and lights, for POV-Ray takes
// everything nearer than a millimetre for one point.
#pragma once

#include "model/view.h"

#include <span>

namespace lodestone::povray {

/// POV-Ray's own limit, in its units: shadows begin, and rays go on, no nearer than this.
inline constexpr double kTolerance = 1e-3;

/// The least power of two (exact: no digit changes) that makes the tolerance smaller than a pixel
/// at each of these bounds (world frame): at its center, or at its radius where the eye is nearer
/// than that. 1 for scenes of everyday size; less than asked for where the whole would become
/// larger than POV-Ray's numbers bear.
double magnification(const View& view, std::span<const Bound> bounds);

/// The same picture of a world that is `times` as large. Powers grow with the square of it.
Camera magnified(Camera camera, double times);
Light magnified(Light light, double times);
Affine magnified(Affine transform, double times);
Bound magnified(Bound bound, double times);

}  // namespace lodestone::povray
