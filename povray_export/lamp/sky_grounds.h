// SPDX-License-Identifier: GPL-3.0-or-later
// Sky grounds: what hides the sky below a thing that moves, without a ray; and which ground is the
// floor of all.
#pragma once

#include "light/sky/sky_horizon.h"
#include "povray_export/lamp/sky_things.h"

#include <vector>

namespace lodestone::povray {

/// The widest things that rest. A thing that moves has no sky below while it is above one of them:
/// rays would tell more, and would have to be cast anew in every frame.
class SkyGrounds {
public:
    explicit SkyGrounds(const SkyThings& all);

    /// The sky below a thing, by its axis that is nearest to the vertical: none above a ground that is
    /// several times as wide, all of it elsewhere.
    light::SkyHorizon horizon(const SkyThing& thing) const;
    /// Whether a thing is flat, wide, and has nothing that hides the sky below it: nobody sees what
    /// comes through its edges.
    bool is_floor(const SkyThing& thing) const;

private:
    std::vector<Box3> grounds_;  // world, the widest one first
    std::vector<Box3> floors_;   // of them
};

}  // namespace lodestone::povray
