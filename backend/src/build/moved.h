// SPDX-License-Identifier: GPL-3.0-or-later
// Moved: groups that are another one, somewhere else.
#pragma once

#include "build/surroundings.h"

#include <vector>

namespace lodestone::build {

/// A group that places the same things in the same way as another: turned about Z, as the light
/// comes from above, and moved.
struct Moved {
    ObjectIndex index = kNoObject;
    ObjectIndex original = kNoObject;
    Affine place;    // the original's frame -> its own
    double off = 0;  // what is placed is nowhere farther from where the original is put, metres
};

/// Takes those out of `groups` that are one that comes before them, to a ten thousandth of the
/// radius. Both are drawn equally often, and nothing around them makes a difference.
std::vector<Moved> take_moved(std::vector<ObjectIndex>& groups, const Model& model,
                              const Surroundings& surroundings);

/// Gives a group the attributes and the stand-ins of its original, which is built.
void add_moved(Model& model, const Moved& moved);

}  // namespace lodestone::build
