// SPDX-License-Identifier: GPL-3.0-or-later
// Chosen: that a cut belongs to what it is asked with, and the meshes of what it shows.
#pragma once

#include "base/job.h"
#include "capi/handles.h"

namespace lodestone::capi {

/// Throws Error(StaleId) unless the cut was made from this model.
void require_made_from(const lds_model& model, const lds_cut& cut);

/// The same, and unless the model's groups place what they placed then where they placed it.
void require_current(const lds_model& model, const lds_cut& cut);

/// The levels of a node's object; throws Error(StaleId) where it has no number `lod` any more.
std::vector<Representation>& levels_with(lds_model& model, const choose::CutNode& node,
                                         uint32_t lod);

/// Makes the levels resident of which a cut's surfaces take chunks.
void load_surfaces(lds_model& model, const lds_cut& cut, const Job& job);

/// Index of the node that a choice is; throws unless the cut is current and has it.
uint32_t node_at(const lds_model& model, const lds_cut& cut, size_t position);

/// Reads the meshes of these levels of cut.chosen that are not in memory yet; a level that no
/// object has (view::kBoxOnly) needs none.
void load_levels(lds_model& model, const choose::Cut& cut, const std::vector<uint32_t>& levels,
                 const Job& job);

}  // namespace lodestone::capi
