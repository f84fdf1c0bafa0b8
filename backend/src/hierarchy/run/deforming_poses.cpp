// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/run/deforming_poses.h"

#include "base/maths.h"

#include <algorithm>
#include <cmath>

namespace lodestone::hierarchy {

DeformingPoses::DeformingPoses(std::span<const Model* const> models) {
    for (const Model* model : models) {
        PoseModel& added = models_.emplace_back(PoseModel{model, {}});
        for (ObjectIndex i = 0; i < model->objects.size(); ++i) {
            const Object& object = model->objects[i];
            if (object.pose != nullptr && !object.group() && !object.representations.empty())
                added.by_uid.emplace(object.uid, i);
        }
    }
}

std::optional<PoseBinding> DeformingPoses::of(const Object& object, Hash settings) const {
    if (object.pose == nullptr || object.group())
        return std::nullopt;
    PoseBinding bind;
    Hasher hasher;
    hasher.value(settings).value(object.pose->connectivity).value(object.role);
    for (const PoseModel& held : models_) {
        const auto at = held.by_uid.find(object.uid);
        if (at == held.by_uid.end())
            continue;
        const Object& there = held.model->objects[at->second];
        if (there.pose->connectivity != object.pose->connectivity)
            continue;
        const PosedSurface& pose = *there.pose;
        if (!all_finite(pose.points))
            continue;
        if (bind.object == nullptr) {
            bind.object = &there;
            bind.model = held.model;
            // Materials too: levels are painted like what can be seen of the finest.
            hasher.value(there.representations[0].summary.hash);
        } else {
            const auto same = [&](const PosedSurface* other) {
                return other->points == pose.points;
            };
            if (same(bind.object->pose.get()) ||
                std::any_of(bind.others.begin(), bind.others.end(), same))
                continue;  // it rests there
            bind.others.push_back(&pose);
        }
        hasher.array(std::span<const glm::vec3>(pose.points));
    }
    if (bind.object == nullptr)
        return std::nullopt;
    bind.hash = hasher.result();
    return bind;
}

}  // namespace lodestone::hierarchy
