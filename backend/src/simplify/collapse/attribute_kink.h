// SPDX-License-Identifier: GPL-3.0-or-later
// Attribute kink: where the paint of a surface ends, or its texture is stretched otherwise.
#pragma once

#include "simplify/collapse/collapse_mesh.h"

namespace lodestone::simplify {

/// An edge between vertices a and b, and the two triangles on it.
struct SharedEdge {
    uint32_t a, b;
    uint32_t t0, t1;
};

/// How far the colors on both sides of an edge are from one linear ramp, at the nearer of the two
/// opposite corners: 0 inside a smooth ramp, up to 1 where paint ends. The colors are compared
/// roughly as a picture encodes them.
double color_kink(const CollapseMesh& mesh, const SharedEdge& edge);

/// How much faster texture coordinates change on one side of an edge than on the other, as a share
/// of how fast they change: 0 where both triangles show one linear map, 1 at most.
double texture_kink(const CollapseMesh& mesh, const SharedEdge& edge);

}  // namespace lodestone::simplify
