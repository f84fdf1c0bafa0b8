// SPDX-License-Identifier: GPL-3.0-or-later
// Surface detail: which level each chunk of a large surface is taken from in a picture, and the
// meshes that this makes. A cut says for such an object only which level is good enough everywhere.
// source: dissertation 3.2.2.
#pragma once

#include "choose/cut.h"

namespace lodestone::choose {

/// The choice for one occurrence of a surface.
struct SurfaceDetail {
    uint32_t node = 0;            // in Cut::nodes
    std::vector<uint32_t> lods;   // the LOD number of each chunk
    uint64_t triangles = 0;       // of all of them
    uint64_t bytes = 0;           // in the renderer
    DrawCost whole;               // that of the level of the cut
    double largest_error_px = 0;  // on screen
};

/// Chooses for the nodes of a cut of this model and view that are drawn by levels of large
/// surfaces; those are left out that are as cheap when drawn by the level of the cut. A node of a
/// level is good enough as a whole object is (docs/architecture.md, Choosing), by the box of what
/// it stands for; where it is not, the nodes of the next finer level are asked. The result depends
/// on the arguments only.
std::vector<SurfaceDetail> surface_details(const Model& model, const View& view, const Cut& cut);

/// A cut in which surfaces are meshes of their own, and its model.
struct DetailedCut {
    Model model;
    Cut cut;
};

/// Draws each of these nodes by one closed mesh (geometry/closed_surface.h), as the only level of
/// an object that no group places. All levels of which chunks are taken must be resident. A surface
/// whose levels do not fit together is drawn by the finest of them. `details` are those of the
/// model and cut.
DetailedCut draw_surfaces(const Model& model, const Cut& cut,
                          std::span<const SurfaceDetail> details);

}  // namespace lodestone::choose
