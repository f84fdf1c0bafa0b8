// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh tunnels: cuts handles and tunnels where collapses have closed them.
#pragma once

#include "simplify/collapse/adjacency.h"

namespace lodestone::simplify {

/// A tunnel three edges around ends, when one of these is collapsed, as an edge with four
/// triangles: two fans around each of its ends that share it. Each fan gets a vertex of its own,
/// which cuts the tunnel there and caps both stumps by nothing. So do fans that share no edge.
/// Edges with four triangles whose fans run on from one such edge to another (walls that cross,
/// loops around a closed tunnel) stay, unless `loops`: then solids that touch there part. False:
/// there was nothing to cut. Otherwise a part may have become several.
bool cut_tunnels(CollapseMesh& mesh, bool loops);

/// Whether any edge has more than two triangles.
bool has_tunnels(const CollapseMesh& mesh, const Adjacency& adjacency);

}  // namespace lodestone::simplify
