// SPDX-License-Identifier: GPL-3.0-or-later
// Placement: one use of an object inside an assembly.
#pragma once

#include "base/maths.h"

#include <array>
#include <cstdint>
#include <memory>
#include <string>

namespace lodestone {

/// An index into Model::objects.
using ObjectIndex = uint32_t;
inline constexpr ObjectIndex kNoObject = ~ObjectIndex{0};

/// Bits of the ray classes (docs/architecture.md, Words). The camera's counts behind glass, too.
using RayMask = uint8_t;
/// Law: a bit of its own each, as lds_ray_class of the C interface and our files have them.
inline constexpr RayMask kCameraRays = 1;
/// Law: as kCameraRays.
inline constexpr RayMask kReflectionRays = 2;
/// Law: as kCameraRays.
inline constexpr RayMask kShadowRays = 4;
/// Law: as kCameraRays.
inline constexpr RayMask kRadiosityRays = 8;
/// All of them, rising.
inline constexpr std::array kRayClasses{kCameraRays, kReflectionRays, kShadowRays, kRadiosityRays};
/// Law: the bits up to that of the last class.
inline constexpr RayMask kAllRays = 2 * kRayClasses.back() - 1;
/// Those that may meet other representations than the camera's rays do. The C interface numbers
/// them without the camera's bit.
inline constexpr RayMask kIndirectRays = kAllRays & ~kCameraRays;

/// No limit on how coarse something is drawn.
inline constexpr uint32_t kAnyLevel = ~uint32_t{0};
/// Importances are kept within 1 / kMostImportance ... kMostImportance.
/// Taste: a larger value lets one thing take nearly all of a budget.
inline constexpr double kMostImportance = 64;

struct Placement {
    ObjectIndex object = kNoObject;
    Affine transform;       // the object's frame -> the group's frame
    std::string name;       // the user's name for this use, e.g. "Chair.003"
    RayMask hidden = 0;     // ray classes that do not see it, nor anything below it
    double importance = 1;  // it and all below it are drawn this many times finer (5.5.5)
    /// The largest LOD number it is drawn with: groups around it are opened. 0: the original, also
    /// of all below it.
    uint32_t coarsest = kAnyLevel;
    /// The least LOD number; above `coarsest` it counts as that. Both the same: a pin.
    uint32_t finest = 0;
    /// `transform` when the shutter closes; null: it rests in its group. Belongs to one frame: no
    /// store keeps it, and no hash counts it.
    std::shared_ptr<const Affine> closing{};

    /// Whether it is drawn otherwise than its object is elsewhere.
    bool has_overrides() const { return importance != 1 || coarsest != kAnyLevel || finest != 0; }
};

}  // namespace lodestone
