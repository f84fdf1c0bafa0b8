// SPDX-License-Identifier: GPL-3.0-or-later
// Strand tubes: hair and grass as polylines with radii, and the tapered tubes that draw them.
#pragma once

#include "model/mesh.h"

#include <span>

namespace lodestone {

/// The points of all strands in a row, root first; strand i has counts[i] of them. In metres.
struct HairStrands {
    std::span<const glm::vec3> points;
    std::span<const float> radii;      // one for each point
    std::span<const uint32_t> counts;  // their sum is points.size()
    std::span<const uint16_t> slots;   // one for each strand, or empty (all in slot 0)
    std::span<const glm::vec2> uvs;    // one for each strand: where it grows; or empty
};

/// One closed three-sided tube for each strand, smooth shaded, through its points in a smooth curve
/// (as Blender draws hair). Points that are not numbers, and strands without length or radius, draw
/// nothing. Bends of less than a quarter of the strand's radius are straightened.
///
/// Why tubes and not POV-Ray's cones: all code that draws, measures, stores or views a mesh can use
/// them, and a straight strand costs 4 or 8 triangles, about as much as one cone costs POV-Ray (a
/// sixth of the bytes each). Why three sides: strands are a few pixels wide at most, normals make
/// them look round, and the prism is widened so that its mean shadow over all directions is the
/// cone's (Cauchy: a convex section of perimeter p is p / pi wide on average). Throws
/// Error(InvalidArgument) when the arrays do not fit together or the mesh would be too large.
Mesh tubes_of(const HairStrands& strands);

}  // namespace lodestone
