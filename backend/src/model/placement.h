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

/// Bits of the ray classes (DESIGN: "ray class"): the camera's, and all that is seen through glass.
using RayMask = uint8_t;
inline constexpr RayMask kCameraRays = 1;
inline constexpr RayMask kReflectionRays = 2;
inline constexpr RayMask kShadowRays = 4;
inline constexpr RayMask kRadiosityRays = 8;
inline constexpr RayMask kAllRays = 15;

struct Placement {
    ObjectIndex object = kNoObject;
    Affine transform;    // the object's frame -> the group's frame
    std::string name;    // the user's name for this use, e.g. "Chair.003"
    RayMask hidden = 0;  // ray classes that do not see it, nor anything below it
};

}  // namespace lodestone
