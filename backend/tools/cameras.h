// SPDX-License-Identifier: GPL-3.0-or-later
// Cameras: what --camera, --eye, --look-at, --angle-deg and --size mean, for every verb that looks.
#pragma once

#include "lodestone/lodestone.h"

#include "arguments.h"

#include <optional>
#include <utility>

namespace lodestone::tools {

/// --size, if it is given. Throws UsageError.
std::optional<std::pair<int, int>> size_of(const CommandArguments& arguments);

/// The camera at --eye, else the one that --camera names, else the model's first, else (`frame`)
/// one that sees everything. Without --size the picture is 640 pixels wide in the camera's shape;
/// with one, the camera's width fills the picture's. The view points to `camera`. Throws
/// UsageError.
lds_view view_of(const CommandArguments& arguments, lds_model* model, bool frame,
                 lds_camera& camera);

}  // namespace lodestone::tools
