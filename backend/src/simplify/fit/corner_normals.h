// SPDX-License-Identifier: GPL-3.0-or-later
// Corner normals: what triangles show where the normals they were left with do not show the
// original.
#pragma once

#include "simplify/collapse/adjacency.h"

namespace lodestone::simplify {

/// Three normals a triangle, for extract(): those of corners whose triangle would be shaded unlike
/// the original (`source`, the mesh that `mesh` was opened from), zero where a wedge's normal does.
/// A wedge on an edge of a fine mesh has the mean normal of both sides, which the edge's own small
/// triangles blend; a large one beside it would blend it over all of its face. Each such triangle
/// gets the linear function nearest to the original's normals at samples of it; corners at one
/// vertex that come out alike share their mean. Empty when no normals are carried or none needs it.
/// `mesh` must be compact and `adjacency` its own. The same bits on any number of threads.
std::vector<glm::vec3> corner_normals(CollapseMesh& mesh, const Mesh& source,
                                      const Adjacency& adjacency, const Job& job);

}  // namespace lodestone::simplify
