// SPDX-License-Identifier: GPL-3.0-or-later
// Color kink: where the paint of a surface ends.
#pragma once

#include "simplify/collapse/collapse_mesh.h"

namespace lodestone::simplify {

/// How far the colors on both sides of an edge are from one linear ramp, at the nearer of the two
/// opposite corners: 0 inside a smooth ramp, up to 1 where paint ends. The colors are compared
/// roughly as a picture encodes them.
double color_kink(const CollapseMesh& mesh, const Triangle& t0, const Triangle& w0,
                  const Triangle& t1, const Triangle& w1, uint32_t a, uint32_t b);

}  // namespace lodestone::simplify
