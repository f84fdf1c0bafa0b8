// SPDX-License-Identifier: GPL-3.0-or-later
// Camera writer: a camera as POV-Ray's camera statement.
#pragma once

#include "model/view.h"

#include <string>

namespace lodestone::povray {

/// Throws Error(InvalidArgument) for a view that cannot be a picture.
void check_view(const View& view);

/// camera{...} with explicit vectors: no angles, no look_at, no flip.
void append_camera(std::string& out, const Camera& camera);

}  // namespace lodestone::povray
