// SPDX-License-Identifier: GPL-3.0-or-later
// Deforming poses: the shapes of a model's deforming objects in the frames that decide their
// levels.
#pragma once

#include "base/hash.h"
#include "model/model.h"

#include <optional>
#include <span>
#include <string>
#include <unordered_map>

namespace lodestone::hierarchy {

/// The source of one object's levels: its poses of the same connectivity.
struct PoseBinding {
    Hash hash = 0;  // of all that the levels depend on
    const Model* model = nullptr;
    const Object* object = nullptr;           // the first pose: levels are made of its mesh
    std::vector<const PosedSurface*> others;  // in the order of the models
};

/// Models of one scene in a few fixed frames. They must outlive it.
class DeformingPoses {
public:
    explicit DeformingPoses(std::span<const Model* const> models);

    bool empty() const { return models_.empty(); }

    /// The object's levels do not depend on the frame it is in, only on which of the poses have its
    /// connectivity. Nothing for an object that no pose is of.
    std::optional<PoseBinding> of(const Object& object, Hash settings) const;

private:
    struct PoseModel {
        const Model* model;
        std::unordered_map<std::string, ObjectIndex> by_uid;  // of what has a pose
    };
    std::vector<PoseModel> models_;
};

}  // namespace lodestone::hierarchy
