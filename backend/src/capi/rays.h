// SPDX-License-Identifier: GPL-3.0-or-later
// Ray cuts: the representations that classes of rays meet, chosen with the shapes of meshes that
// may lie in the store.
#pragma once

#include "capi/handles.h"

namespace lodestone::capi {

/// Chooses the representations that the view's classes of rays meet. Remembers the shapes of meshes
/// in the model.
std::vector<choose::RayCut> choose_rays(lds_model& model, const View& view, const choose::Cut& cut,
                                        const Job& job);

/// Makes the meshes resident that only some classes meet.
void load_own(lds_model& model, const lds_cut& cut, const Job& job);

}  // namespace lodestone::capi
