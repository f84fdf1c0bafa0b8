// SPDX-License-Identifier: GPL-3.0-or-later
// Camera writer: a camera as POV-Ray's camera statement.
#pragma once

#include "base/error.h"
#include "model/view.h"
#include "povray_export/scene/shading.h"

#include <string>

namespace lodestone::povray {

/// Throws Error(InvalidArgument) for a view that cannot be a picture.
void check_view(const View& view);

/// Whether depth is blurred: then each pixel has many samples, spread over it, and antialiasing
/// would only repeat all of them (measured: 3 times the time for the same edges).
bool has_depth_blur(const Camera& camera);

/// Appends camera{...} with explicit vectors: no angles, no look_at, no flip. The blur of the depth
/// is that of a thin lens, like Cycles'; orthographic cameras have none in POV-Ray, which becomes a
/// problem.
void append_camera(std::string& out, const Camera& camera, Antialiasing antialiasing,
                   Problems& problems);

}  // namespace lodestone::povray
