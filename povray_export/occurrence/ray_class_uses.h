// SPDX-License-Identifier: GPL-3.0-or-later
// Ray class uses: representations that only some classes of rays meet, besides or instead of the
// cut's.
#pragma once

#include "choose/ray_class/ray_cut.h"

#include <span>

namespace lodestone::povray {

/// One representation that some classes of rays meet.
struct OwnUse {
    uint32_t node = 0;
    uint32_t lod = 0;
    Affine world;
    /// Not 0: it stands in place of what the camera sees, for these classes only; 0: it stands
    /// alone, for all.
    RayMask in_place = 0;
    RayMask hidden = 0;    // ray classes that do not see it
    bool textures = true;  // false for an opaque thing that only throws a shadow
};

/// The uses of all classes, each once. `softened` says that lights are as soft as the choice was
/// made for; else soft edges are no reason for a use.
std::vector<OwnUse> own_uses(const Model& model, const choose::Cut& cut,
                             std::span<const choose::RayCut> rays, bool softened);

/// Whether, for each node, no ray meets it, nor anything below it, as something else stands for it.
std::vector<uint8_t> nodes_left_out(const choose::Cut& cut, std::span<const choose::RayCut> rays);

/// The classes, for each node, that meet something else in its place: its own and those of groups
/// above.
std::vector<RayMask> replaced_ray_classes(const choose::Cut& cut, std::vector<RayMask> replaced);

}  // namespace lodestone::povray
