// SPDX-License-Identifier: GPL-3.0-or-later
// Chosen: the meshes of what a cut shows, brought into memory.
#pragma once

#include "base/job.h"
#include "capi/handles.h"

namespace lodestone::capi {

/// Reads the meshes of these levels of cut.chosen that are not in memory yet; a level that no object
/// has (quality::kBoxOnly) needs none.
void load_levels(lds_model& model, const quality::Cut& cut, const std::vector<uint32_t>& levels,
                 const Job& job);

}  // namespace lodestone::capi
