// SPDX-License-Identifier: GPL-3.0-or-later
// Rays: what classes of rays meet, chosen with the shapes of meshes that may lie in the store.
#pragma once

#include "capi/handles.h"

namespace lodestone::capi {

/// What the classes the view asks for meet. Remembers shapes in the model.
std::vector<choose::RayCut> choose_rays(lds_model& model, const View& view, const choose::Cut& cut,
                                        const Job& job);

/// Reads the meshes that only some classes meet.
void load_own(lds_model& model, const lds_cut& cut, const Job& job);

}  // namespace lodestone::capi
