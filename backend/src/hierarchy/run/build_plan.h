// SPDX-License-Identifier: GPL-3.0-or-later
// Build plan: which objects that a model draws are in its store already, and which are to be built.
#pragma once

#include "hierarchy/build_settings.h"
#include "hierarchy/run/build_demand.h"
#include "hierarchy/run/deforming_poses.h"
#include "hierarchy/run/moved_copies.h"
#include "hierarchy/run/stand_in_surroundings.h"
#include "hierarchy/run/stored_stand_ins.h"
#include "model/model.h"

#include <optional>
#include <utility>

namespace lodestone::hierarchy {

/// Something stale that is to be built, for itself, for its copies (objects of the same content)
/// and for what is the same group moved.
struct BuildTask : StaleObject {
    std::optional<PoseBinding> bind;  // of what deforms
    std::vector<MovedCopy> moved;
};

struct BuildPlan {
    uint64_t objects = 0;                   // that show anything
    std::vector<Hash> wanted;               // build hashes, by object
    std::vector<MovedCopy> moved;           // whose originals the shelf has
    std::vector<BuildTask> tasks;           // children before parents
    std::vector<ObjectIndex> not_followed;  // deform, but none of the poses is theirs
};

/// Plans the objects of `order` (children before parents), within the scope of the settings, and
/// gives those their stand-ins that the shelf has some for. `palette`: of the model. The plan is
/// valid as long as the models of poses. Throws Error(InvalidArgument) for a
/// scope that names no object.
BuildPlan plan_build(Model& model, const std::vector<ObjectIndex>& order,
                     const StandInSurroundings& surroundings, const StoredStandIns& shelf,
                     MaterialPalette& palette, const BuildSettings& settings);

}  // namespace lodestone::hierarchy
