// SPDX-License-Identifier: GPL-3.0-or-later
// Build demand: which of the objects without stand-ins a picture gains most from.
#pragma once

#include "base/job.h"
#include "hierarchy/build_settings.h"
#include "model/model.h"

namespace lodestone::hierarchy {

/// Something stale: an object, and whatever else takes over what is built for it.
struct StaleObject {
    ObjectIndex index = kNoObject;
    std::vector<ObjectIndex> copies;
};

/// For each of `stale` (children before parents) 1 when it is to be built: first the objects that
/// save the picture most time for the time they take, then groups of which nothing stale is left
/// below. From counts alone: the same on every machine. `model` has the stand-ins the store holds,
/// settings a demand.
std::vector<uint8_t> select_demanded(const Model& model, const std::vector<StaleObject>& stale,
                                     const BuildSettings& settings, const Job& job);

}  // namespace lodestone::hierarchy
