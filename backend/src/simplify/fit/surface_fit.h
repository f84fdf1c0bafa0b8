// SPDX-License-Identifier: GPL-3.0-or-later
// Surface fit: moves the vertices of a simplified mesh to where they are nearest to the original
// surface.
#pragma once

#include "simplify/collapse/adjacency.h"

namespace lodestone::simplify {

struct FitOptions {
    /// The triangles of the original that are sampled, for each vertex of the simplified mesh.
    double samples = 8;
    double share = 1;  // the most that are sampled, as a share of the original's triangles
    /// How often each sample searches for its nearest place: the coarser the mesh, the more often
    /// it pays, and the less time it takes.
    int least_sweeps = 1;
    int most_sweeps = 1;
    int iterations = 3;  // those of the solver in each sweep
    /// Flips edges before solving and draws back vertices that stick out. Needs many samples.
    bool careful = false;
    /// Holds each vertex in its place, relative to the area of the samples near it. The more
    /// samples and sweeps, the smaller it can be.
    float hold = 0.1f;
    /// Samples that a closed part of the mesh lies outside of count 1 plus this factor times.
    float outside = 0;
    /// The most vertices that are put back where the mesh is farthest from the original. Needs many
    /// samples.
    size_t insert = 0;
};

// The fit of mode fast.
// Fitted: by tests/bench/peers/bench_simplify.py, nine shared models at four targets.
inline constexpr FitOptions kFastFit{8, 0.5, 1, 1, 2, false, 0.1f, 0};

/// Least squares of the distances from samples of the original (`source`, the mesh that `mesh` was
/// opened from) to the surface they are nearest to, over all vertices together but those on borders
/// of chunks, which stay; samples on open borders count their distances to the outline, too. Closed
/// parts of at most 8 triangles (bricks, boards) stay as they are. `mesh` must be compact and
/// `adjacency` its own. No triangle turns over. A mesh with other poses is left as it is. source:
/// Hoppe et al. 1993 (mesh optimization), with distances to planes.
void fit_surface(CollapseMesh& mesh, const Mesh& source, Adjacency& adjacency,
                 const FitOptions& options, const Job& job);

}  // namespace lodestone::simplify
