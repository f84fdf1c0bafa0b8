// SPDX-License-Identifier: GPL-3.0-or-later
// Vertex insertion: puts vertices back where a simplified mesh is farthest from the original.
#pragma once

#include "simplify/fit/fit_samples.h"

namespace lodestone::simplify {

/// Where vertices of the original are far from the mesh, or its vertices, edges and triangles are
/// far from the surface that `samples` were taken from: splits the triangle or edge there by a
/// vertex on the original, `most` at most (two more triangles each), or moves the vertex. The
/// farthest place comes first, and a change is kept only if its surroundings then miss less. Needs
/// many samples; those of triangles that changed, and `adjacency`, are out of date afterwards.
/// Returns how many vertices were inserted or moved.
size_t insert_vertices(FitPlaces& places, const Adjacency& adjacency, const FitSamples& samples,
                       size_t most, const Job& job);

}  // namespace lodestone::simplify
