// SPDX-License-Identifier: GPL-3.0-or-later
// Touching sheets: gives surfaces that merely touch or coincide vertices of their own.
#pragma once

#include "simplify/collapse/collapse_mesh.h"

namespace lodestone::simplify {

/// Coinciding triangles (the two sides of a card, accidental copies): the second of each becomes
/// part of a second layer with its own vertices, and so on. Otherwise every edge of such a sheet
/// would be non-manifold and nothing could be collapsed. Triangles must be in the order of their
/// lowest vertices.
void split_layers(CollapseMesh& mesh);

/// A vertex whose triangles form several fans that share no edge gets one copy per fan. `adjacency`
/// gets the lists of the mesh as it is then.
void split_fans(CollapseMesh& mesh, Adjacency& adjacency);

/// Marks all but the first of coinciding triangles dead, whichever side they show.
void drop_copies(CollapseMesh& mesh);

/// Numbers the connected parts, in the order of their first vertex.
void find_parts(CollapseMesh& mesh);

}  // namespace lodestone::simplify
