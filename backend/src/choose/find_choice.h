// SPDX-License-Identifier: GPL-3.0-or-later
// Find a choice: the representation by which a cut draws one thing of the scene.
#pragma once

#include "choose/cut.h"

#include <optional>

namespace lodestone::choose {

/// How a cut draws an occurrence.
enum class DrawnState : uint8_t {
    Missing = 0,   // the model has no such occurrence
    Itself = 1,    // by a level of its own
    InGroup = 2,   // by a stand-in for a group around it
    Opened = 3,    // it is a group, drawn by what is in it
    NotDrawn = 4,  // no ray sees it, or a lens hides it
};

struct FoundChoice {
    DrawnState drawn = DrawnState::Missing;
    uint32_t node = kNoParent;  // the chosen node or the opened one
};

/// Finds the occurrence of `object` whose transform is nearest to `world` (the first of equally
/// near ones). The result is Missing when the two differ by more than 1/1000 of the distance from
/// the origin, or than 1 mm. cost: one visit for each group that holds the object, and for each of
/// its occurrences.
FoundChoice find_choice(const Model& model, const Cut& cut, ObjectIndex object,
                        const Affine& world);

/// The path of placements below a group to the object that makes the group's `demand` as large as
/// it is; "" where nothing in the group is more important than the group itself.
std::string most_demanding(const Model& model, ObjectIndex group);

}  // namespace lodestone::choose
