// SPDX-License-Identifier: GPL-3.0-or-later
// Tiles: the hierarchy as any 3D Tiles viewer understands it.
#pragma once

#include "model/model.h"

#include <string>

namespace lodestone::segment {

/// `"geometricError":...,"root":{...}` of a tileset.json: a chain of REPLACE tiles for each list of
/// representations, coarse to fine, an assembly as the children of its finest stand-in. Geometric
/// error is the error, raised where needed to exceed every child's after its stretch; 0 at the
/// finest; the top one is the size of the whole, so that something is always drawn.
/// A tree has no sharing: its length goes with the occurrences. Of a million tiles or more only the
/// stand-ins of the whole are there.
std::string tiles_text(const Model& model);

}  // namespace lodestone::segment
