// SPDX-License-Identifier: GPL-3.0-or-later
// Moved copies: groups that are another one, somewhere else.
#pragma once

#include "hierarchy/run/stand_in_surroundings.h"

#include <vector>

namespace lodestone::hierarchy {

/// A group that places the same things in the same way as another: turned about Z, as the light
/// comes from above, and moved.
struct MovedCopy {
    ObjectIndex index = kNoObject;
    ObjectIndex original = kNoObject;
    Affine place;    // the original's frame -> its own
    double off = 0;  // what is placed is nowhere farther from where the original is put, metres
};

/// The groups of `order` that are one that comes before them, to a ten thousandth of the radius.
/// Both are drawn equally often, and nothing around them makes a difference. No original is itself
/// another one moved.
std::vector<MovedCopy> moved_groups(const Model& model, const std::vector<ObjectIndex>& order,
                                    const StandInSurroundings& surroundings);

/// Gives a group the attributes and the stand-ins of its original, which has them.
void add_moved_copy(Model& model, const MovedCopy& moved, const MeshSource& source);

}  // namespace lodestone::hierarchy
