// SPDX-License-Identifier: GPL-3.0-or-later
// Fit: moves the vertices of a simplified mesh to where they are nearest to the original surface.
#pragma once

#include "simplify/collapse/adjacency.h"

namespace lodestone::simplify {

struct FitOptions {
    double samples = 8;  // of the original's triangles, for each vertex of the simplified mesh
    double share = 1;    // of the original's triangles, at most
    /// How often each sample looks for what it is nearest to: the coarser the mesh, the more often
    /// it pays, and the less time it takes.
    int least_sweeps = 1;
    int most_sweeps = 1;
    int iterations = 3;  // of the solver in each sweep
    /// Flips edges before solving and draws back vertices that stick out. Takes many samples.
    bool careful = false;
    /// Holds each vertex where it is, relative to the area of the samples near it. The more samples
    /// and sweeps, the less it takes.
    float hold = 0.1f;
    /// Samples that a closed part lies outside of count so much more.
    float outside = 0;
    /// Vertices that may be put back where it is farthest from the original. Takes many samples.
    size_t insert = 0;
};

/// Least squares: the distances from samples of the original (`source`, the mesh that `mesh` was
/// opened from) to the surface they are nearest to, over all vertices together; those on open
/// borders also to the outline's. Closed parts of at most 8 triangles (bricks, boards) stay as they
/// are. `mesh` must be compact and `adjacency` its own. No triangle turns over. A mesh with other
/// poses is left as it is. source: Hoppe et al. 1993 (mesh optimization), with distances to planes.
void fit_surface(CollapseMesh& mesh, const Mesh& source, Adjacency& adjacency,
                 const FitOptions& options, const Job& job);

}  // namespace lodestone::simplify
