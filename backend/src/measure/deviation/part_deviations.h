// SPDX-License-Identifier: GPL-3.0-or-later
// Part deviations: how far each part of a surface is from a stand-in, and back.
#pragma once

#include "measure/deviation/surface_deviation.h"

namespace lodestone::measure {

/// A surface that is divided into parts.
struct PartedSurface {
    const Mesh& mesh;
    const ray::MeshScene& scene;       // of the mesh
    std::span<const uint32_t> order;   // its triangles, part by part
    std::span<const uint32_t> before;  // the triangles of the parts before each part, and of all
};

/// For each part the deviation of what the two surfaces have there: of a thousand points or more,
/// uniform in the area of the one's part, from all of the other, both ways. Only places count, not
/// looks; what is hidden counts, too. The bits are the same on any number of threads. Throws Error:
/// Cancelled.
std::vector<SurfaceDeviation> part_deviations(const PartedSurface& finest,
                                              const PartedSurface& stand_in, uint64_t seed,
                                              const Job& job);

}  // namespace lodestone::measure
