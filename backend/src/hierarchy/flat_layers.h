// SPDX-License-Identifier: GPL-3.0-or-later
// Layers: which flat things lie on others, or under them: lines on roads, rugs on floors.
#pragma once

#include "base/job.h"
#include "hierarchy/mesh_source.h"

namespace lodestone::hierarchy {

/// By object. 0: nothing of it lies in thin layers; else a hash that tells which of its leaves do
/// (for a leaf any other number). A flat leaf does where, at one of its first places, most of the
/// narrower of two surfaces is nearer to the other than a sixteenth of its width. Environment is
/// not asked, but lies under others. What would take too long to find out counts as lying in
/// layers. `order` is bottom_up's.
std::vector<Hash> layers_of(const Model& model, const std::vector<ObjectIndex>& order,
                            const MeshSource& source, const Job& job);

}  // namespace lodestone::hierarchy
