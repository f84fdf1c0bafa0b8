// SPDX-License-Identifier: GPL-3.0-or-later
// Bound levels as bytes: a computed cache of one machine, in its byte order, checked when read.
#pragma once

#include "deform/level_following.h"

#include <string>
#include <vector>

namespace lodestone::segment {

/// Fine to coarse.
using BoundLevels = std::vector<deform::BoundLevel>;

std::string bytes_of(const BoundLevels& levels);

/// Every number has its bits again. Throws Error(BadFile) for bytes that bytes_of cannot have made.
BoundLevels bound_levels_of(const std::string& bytes);

}  // namespace lodestone::segment
