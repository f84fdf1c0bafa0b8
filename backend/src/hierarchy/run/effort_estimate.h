// SPDX-License-Identifier: GPL-3.0-or-later
// Effort estimates: the times of building and drawing, guessed from counts before anything is done.
#pragma once

#include "choose/cut.h"
#include "hierarchy/build_settings.h"
#include "model/model.h"

namespace lodestone::hierarchy {

/// The CPU seconds that the stand-ins of one object take to build.
double seconds_to_build(const Object& object, const BuildSettings& settings);

/// The CPU seconds that the model's renderer takes for a picture.
double seconds_to_draw(const Model& model, const choose::Cut& cut, const View& view);

}  // namespace lodestone::hierarchy
