// SPDX-License-Identifier: GPL-3.0-or-later
// Invertible transform: transforms that POV-Ray can undo, as it does for every ray.
#pragma once

#include "base/maths.h"

namespace lodestone::povray {

/// Makes a transform one that POV-Ray can invert; false when nothing under it could be seen.
bool make_invertible(Affine& transform);

}  // namespace lodestone::povray
