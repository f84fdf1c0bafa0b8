// SPDX-License-Identifier: GPL-3.0-or-later
// Closed surface: one mesh from chunks of several levels of a large surface, without gaps.
#pragma once

#include "model/surface_level.h"

#include <span>

namespace lodestone::geometry {

/// A level that chunks are taken from.
struct SurfaceSource {
    const Mesh& mesh;
    const SurfaceLevel& level;
    std::vector<uint16_t> slots = {};  // empty, or what each of its slots is in the result
};

/// The mesh that takes each chunk from the level `source_of[chunk]` of `sources`. All chunks of a
/// node must be taken from the same level as that node is. Every vertex on a border moves to the
/// one that stands for it in the coarsest level around it (BorderPoint::heir), and shows what it
/// shows there; triangles that lose their area by that are left out. As this depends on the vertex
/// alone, the borders of neighbors fit together: the surface is closed where the original is.
/// Throws Error(InvalidArgument) for sources of different surfaces, or chunks that do not fit.
Mesh closed_surface(std::span<const SurfaceSource> sources, std::span<const uint8_t> source_of);

}  // namespace lodestone::geometry
