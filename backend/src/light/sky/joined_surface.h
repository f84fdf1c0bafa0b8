// SPDX-License-Identifier: GPL-3.0-or-later
// Joined surface: all that one thing stands for, as a surface in its frame.
#pragma once

#include "light/sky/sky_scene.h"

#include <optional>

namespace lodestone::light {

/// Triangles that are joined at most.
/// Taste: with more, rays begin at the originals of larger groups, too, for memory and time of each
/// stand-in. No other value was measured.
inline constexpr uint64_t kMostJoinedTriangles = 500'000;

/// Joins occluders, which were added to the surfaces, in the frame of what is placed at `world`.
/// None where there are no triangles, or more than so many, or where nothing leads back from
/// `world`. Rays meet what light goes through like the rest: its slot is not opaque.
std::optional<SkySurface> joined_surface(const SkySurfaces& surfaces,
                                         std::span<const SkyOccluder> occluders,
                                         const Affine& world,
                                         uint64_t most_triangles = kMostJoinedTriangles);

}  // namespace lodestone::light
