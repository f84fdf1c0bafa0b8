// SPDX-License-Identifier: GPL-3.0-or-later
// Effort: how long building and drawing take, guessed from counts before anything is done.
#pragma once

#include "choose/cut.h"
#include "hierarchy/build_settings.h"
#include "model/model.h"

namespace lodestone::hierarchy {

/// CPU seconds to make the stand-ins of one object.
double seconds_to_build(const Object& object, const BuildSettings& settings);

/// CPU seconds that a picture saves in POV-Ray for each triangle it need not read, and for each
/// occurrence it need not place.
inline constexpr double kSecondsPerTriangle = 2e-6;
inline constexpr double kSecondsPerOccurrence = 2e-5;

/// CPU seconds of a picture in POV-Ray.
double seconds_to_draw(const Model& model, const choose::Cut& cut, const View& view);

}  // namespace lodestone::hierarchy
