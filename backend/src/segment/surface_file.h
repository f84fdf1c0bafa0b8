// SPDX-License-Identifier: GPL-3.0-or-later
// Surface levels as bytes: a computed cache of one machine, in its byte order, checked when read.
#pragma once

#include "model/surface_level.h"

#include <string>

namespace lodestone::segment {

std::string bytes_of(const SurfaceLevel& level);

/// Every number has its bits again; its ranges are for check() to look at, which knows the mesh.
/// Throws Error(BadFile) for bytes that bytes_of cannot have made.
SurfaceLevel surface_level_of(const std::string& bytes);

}  // namespace lodestone::segment
