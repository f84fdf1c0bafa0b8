// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh tunnels: cuts handles and tunnels where collapses have closed them.
#pragma once

#include "simplify/collapse/adjacency.h"

namespace lodestone::simplify {

/// Cuts tunnels. When an edge of a tunnel three edges around is collapsed, the tunnel ends as an
/// edge with four triangles, and around each of its ends two fans share this edge. Each fan gets a
/// vertex of its own, which cuts the tunnel there and needs no cap on either stump. Fans that share
/// no edge get vertices of their own, too. Edges with four triangles whose fans continue from one
/// such edge to another (walls that cross, loops around a closed tunnel) stay, unless `loops`: then
/// solids that touch there are separated. False: there was nothing to cut. True: a part may have
/// become several.
bool cut_tunnels(CollapseMesh& mesh, bool loops);

/// Whether any edge has more than two triangles.
bool has_tunnels(const CollapseMesh& mesh, const Adjacency& adjacency);

}  // namespace lodestone::simplify
