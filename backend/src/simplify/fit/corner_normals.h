// SPDX-License-Identifier: GPL-3.0-or-later
// Corner normals: normals for triangles whose own would be shaded unlike the original.
#pragma once

#include "simplify/fit/fit_samples.h"

namespace lodestone::simplify {

/// Three normals for each triangle, for extract(). Corners of triangles that would be shaded unlike
/// the original (`source`, the mesh that `mesh` was opened from) get a normal; zero means that the
/// normal of the wedge is right. A wedge on an edge of a fine mesh has the mean normal of both
/// sides, and the small triangles at the edge blend between it and the faces; a large triangle
/// beside the edge would blend it over its whole face. Each such triangle that is about flat gets
/// one normal. What curves keeps its wedges, which fit best as a whole: normals of its own would
/// make each triangle a facet. Where that shows least, in many triangles of a rough mesh, each gets
/// the linear function nearest to the original's normals at samples of it. Corners at one vertex
/// that come out alike share their mean. The result is empty when no normals are carried or none is
/// needed. `mesh` must be compact and `adjacency` its own. Any number of threads gives the same
/// bits. `samples`: of the original's surface on the mesh.
std::vector<glm::vec3> corner_normals(const FitPlaces& places, const Adjacency& adjacency,
                                      const FitSamples& samples, const Job& job);

}  // namespace lodestone::simplify
