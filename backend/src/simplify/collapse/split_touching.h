// SPDX-License-Identifier: GPL-3.0-or-later
// Split touching: gives surfaces that only touch or coincide vertices of their own.
#pragma once

#include "simplify/collapse/collapse_mesh.h"

namespace lodestone::simplify {

/// Splits coinciding triangles (the two sides of a card, accidental copies): the second of each
/// becomes part of a second layer with its own vertices, and so on. Otherwise every edge of such a
/// sheet would be non-manifold and nothing could be collapsed. Triangles must be in the order of
/// their lowest vertices.
void split_layers(CollapseMesh& mesh);

/// Splits a vertex whose triangles form several fans that share no edge: each fan gets a copy.
/// `adjacency` gets the lists of the changed mesh.
void split_fans(CollapseMesh& mesh, Adjacency& adjacency);

/// Marks all but the first of coinciding triangles dead, whichever side they show.
void drop_copies(CollapseMesh& mesh);

/// Numbers the connected parts, in the order of their first vertices.
void find_parts(CollapseMesh& mesh);

}  // namespace lodestone::simplify
