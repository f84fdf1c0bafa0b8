// SPDX-License-Identifier: GPL-3.0-or-later
// Own uses: what only some classes of rays meet of a scene, or all of them in place of the cut's.
#pragma once

#include "choose/ray_class/ray_cut.h"

#include <span>

namespace lodestone::povray {

struct OwnUse {
    uint32_t node = 0;
    uint32_t lod = 0;
    Affine world;
    RayMask in_place = 0;  // of what the camera sees, for these classes only; 0: for all, alone
    RayMask hidden = 0;    // ray classes that do not see it
    bool textures = true;  // what throws the shadow of something opaque needs none
};

/// Each once. `softened`: lights are as soft as the choice was made for; else soft edges are no
/// reason for one.
std::vector<OwnUse> own_uses(const Model& model, const choose::Cut& cut,
                             std::span<const choose::RayCut> rays, bool softened);

/// For each node whether no ray meets it, nor anything below it, as something else stands for it.
std::vector<uint8_t> nodes_left_out(const choose::Cut& cut, std::span<const choose::RayCut> rays);

/// For each node the classes that meet something else in its place: its own and those of groups
/// above.
std::vector<RayMask> replaced_ray_classes(const choose::Cut& cut, std::vector<RayMask> replaced);

}  // namespace lodestone::povray
