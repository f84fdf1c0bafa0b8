// SPDX-License-Identifier: GPL-3.0-or-later
// Effort: how long building and drawing take, guessed from counts before anything is done.
#pragma once

#include "choose/cut.h"
#include "hierarchy/build_settings.h"
#include "model/model.h"

namespace lodestone::hierarchy {

/// CPU seconds to make the stand-ins of one object.
double seconds_to_build(const Object& object, const BuildSettings& settings);

/// CPU seconds that the model's renderer takes for a picture.
double seconds_to_draw(const Model& model, const choose::Cut& cut, const View& view);

}  // namespace lodestone::hierarchy
