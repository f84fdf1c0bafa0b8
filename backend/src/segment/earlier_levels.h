// SPDX-License-Identifier: GPL-3.0-or-later
// Earlier levels: those of what a store held before, so that going back builds nothing.
#pragma once

#include "model/model.h"

#include <filesystem>
#include <functional>

namespace lodestone::segment {

/// The objects of `before` and `earlier`, newest first, whose stand-ins the model that is stored
/// now has not, without what they place. What deforms is left out, whose levels are found another
/// way. Of the oldest, those are left out that are more than `most` bytes, and more objects than a
/// model has mostly. `bytes_of` tells what a stand-in takes.
Model earlier_levels(const Model& now, const Model& before, const Model& earlier, uint64_t most,
                     const std::function<uint64_t(const Representation&)>& bytes_of);

}  // namespace lodestone::segment
