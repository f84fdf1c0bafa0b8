// SPDX-License-Identifier: GPL-3.0-or-later
// Criterion: is a representation good enough from here? (DESIGN 5; dissertation 5.2)
#pragma once

#include "model/view.h"

namespace lodestone::quality {

/// Size in metres of a pixel of `view` at distance z (perspective: proportional to z, never nearer
/// than the near clip; orthographic: the same everywhere).
double pixel_size(const View& view, double z);

/// Error on screen in pixels of a representation with `error` metres under a transform that enlarges
/// by `stretch`, its bound z metres from the eye.
double error_on_screen(const View& view, double error, double stretch, double z);

/// All that refines and coarsens together, kept within 1/64 ... 64; infinite stays so.
double total_refinement(double factors);

/// error * stretch * refine <= T * p(z); T = 0 asks for error 0.
bool good_enough(const View& view, double error, double stretch, double z, double refine = 1);

}  // namespace lodestone::quality
