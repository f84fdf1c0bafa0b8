// SPDX-License-Identifier: GPL-3.0-or-later
// Cameras: the view of --camera, --eye, --look-at, --angle-deg and --size, for every verb that
// looks.
#pragma once

#include "lodestone/lodestone.h"

#include "arguments.h"

#include <optional>
#include <utility>

namespace lodestone::tools {

/// The width and height of --size, if it is given. Throws UsageError.
std::optional<std::pair<int, int>> size_of(const CommandArguments& arguments);

/// The view of the camera at --eye, else of the one that --camera names, else of the model's first,
/// else (`frame`) of one that sees everything. Without --size the picture is 640 pixels wide in the
/// camera's shape; with it, the camera's width fills the picture's. The view points to `camera`.
/// Throws UsageError.
lds_view view_of(const CommandArguments& arguments, lds_model* model, bool frame,
                 lds_camera& camera);

}  // namespace lodestone::tools
