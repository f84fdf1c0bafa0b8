// SPDX-License-Identifier: GPL-3.0-or-later
// Viewer surface: the drawing of a cut as loose triangles, for viewers that show it in false
// colors.
#pragma once

#include "choose/cut.h"

namespace lodestone::view {

/// The value instead of a LOD number where only the box of its bound is shown.
inline constexpr uint32_t kBoxOnly = ~uint32_t{0};

/// For each of cut.chosen the LOD number that shows it so that all together have about
/// `most_triangles` at most: the chosen one, or where that has too many triangles the finest
/// coarser one that has not, or a box. The same limit holds for every occurrence. Each takes at
/// least a box (12 triangles).
std::vector<uint32_t> surface_levels(const Model& model, const choose::Cut& cut,
                                     uint64_t most_triangles);

struct ViewerSurface {
    std::vector<glm::vec3> corners;  // three for each triangle, in the world
    std::vector<uint32_t> owners;    // the position in cut.chosen, for each triangle
};

/// The surface without what cameras do not see. `levels` as above; their meshes must be resident.
/// Any number of threads gives the same result. Throws Error(Internal) for a mesh that is not
/// resident, Error(Cancelled).
ViewerSurface surface_of(const Model& model, const choose::Cut& cut,
                         const std::vector<uint32_t>& levels, const Job& job = {});

/// How light a triangle is shown, 0.55 ... 1: lit from above and a little from the side, on both
/// sides alike, so that shapes can be told in one color.
double shade_of(const glm::vec3* corners);

}  // namespace lodestone::view
