// SPDX-License-Identifier: GPL-3.0-or-later
// Placement: one use of an object inside an assembly.
#pragma once

#include "base/maths.h"

#include <cstdint>
#include <string>

namespace lodestone {

/// Index into Model::objects.
using ObjectIndex = uint32_t;
inline constexpr ObjectIndex kNoObject = ~ObjectIndex{0};

struct Placement {
    ObjectIndex object = kNoObject;
    Affine transform;  // the object's frame -> the group's frame
    std::string name;  // the user's name for this use, e.g. "Chair.003"
};

}  // namespace lodestone
