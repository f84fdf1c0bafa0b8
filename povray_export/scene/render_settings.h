// SPDX-License-Identifier: GPL-3.0-or-later
// Render settings: the size, part and antialiasing of a picture, as POV-Ray's scene.ini has them.
#pragma once

#include "model/view.h"
#include "povray_export/scene/shading.h"

#include <string>

namespace lodestone::povray {

/// The text of scene.ini. `margin`: the pixels that are drawn around a border. `shading` is filled up; `transparent` says that the picture has an alpha
/// channel.
std::string render_settings(const View& view, int margin, const Shading& shading,
                            Antialiasing antialiasing, bool transparent);

}  // namespace lodestone::povray
