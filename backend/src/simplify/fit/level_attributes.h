// SPDX-License-Identifier: GPL-3.0-or-later
// Level attributes: the normals and texture coordinates of a simplified mesh.
#pragma once

#include "simplify/collapse/adjacency.h"

namespace lodestone::simplify {

/// Fits the normals and texture coordinates of the wedges to the original (`source`, the mesh that
/// `mesh` was opened from), and returns the normals of corners that extract() shows instead of the
/// wedges' (see corner_normals). `mesh` must be compact and
/// `adjacency` its own. Any number of threads gives the same bits.
std::vector<glm::vec3> fit_attributes(CollapseMesh& mesh, const Mesh& source,
                                      const Adjacency& adjacency, const Job& job);

}  // namespace lodestone::simplify
