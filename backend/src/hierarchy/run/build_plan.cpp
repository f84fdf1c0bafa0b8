// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/run/build_plan.h"

#include <cmath>
#include <map>

namespace lodestone::hierarchy {
namespace {

/// Whether there is anything to stand in for: not for a group of nothing, as of an empty scene.
bool shows(const Object& object) {
    return !object.representations.empty() && !object.bound().empty();
}

/// A group that is never asked for as one, or that places a single thing, which has its own
/// stand-ins: another one, of one of those, costs as much and is farther off.
bool is_always_opened(const Object& object) {
    return object.group() && (std::isinf(object.demand) ||
                              object.representations[0].assembly().placements.size() == 1);
}

/// `layers`: what layers_of tells of it; `ground`: what grounds_of does.
Hash build_hash_of(const Object& object, Hash settings, Hash layers, uint8_t ground) {
    const Hash hash = Hasher().value(object.shape_hash).value(settings).result();
    if (layers == 0 && ground == 0)
        return hash;
    return Hasher().value(hash).value(layers).value(ground).result();
}

/// Whether an object may be built: true for everything below the scope, or for all without one.
std::vector<bool> within(const std::vector<ObjectIndex>& scope, const Model& model,
                         const std::vector<ObjectIndex>& order) {
    std::vector<bool> inside(model.objects.size(), scope.empty());
    for (const ObjectIndex index : scope) {
        if (index >= model.objects.size())
            fail(Status::InvalidArgument, "the scope names object ", index, " of ",
                 model.objects.size());
        inside[index] = true;
    }
    for (auto at = order.rbegin(); at != order.rend(); ++at) {  // parents before children
        const Object& object = model.objects[*at];
        if (!inside[*at] || !object.group())
            continue;
        for (const Placement& placement : object.representations[0].assembly().placements)
            inside[placement.object] = true;
    }
    return inside;
}

}  // namespace

BuildPlan plan_build(Model& model, const std::vector<ObjectIndex>& order,
                     const StandInSurroundings& surroundings, const StoredStandIns& shelf,
                     MaterialPalette& palette, const BuildSettings& settings) {
    const Hash of_settings = hash_of(settings, model.costs);
    std::vector<bool> inside = within(settings.scope, model, order);
    // A group that is another one moved has the levels of that one, whichever is stale: so an
    // early partial build comes to the same as a whole one.
    std::map<ObjectIndex, MovedCopy> moved;
    for (const MovedCopy& one : moved_groups(model, order, surroundings)) {
        moved.emplace(one.index, one);
        if (inside[one.index])
            inside[one.original] = true;
    }
    const std::vector<uint8_t> deforming = with_deforming(model);
    const DeformingPoses poses(settings.poses);
    BuildPlan plan;
    plan.wanted.resize(model.objects.size());
    std::map<Hash, size_t> task_of;          // content-equal objects are built once
    std::map<Hash, MovedCopy> moved_one_of;  // likewise where they are others moved
    std::map<ObjectIndex, size_t> task_for;
    const auto move = [&](const MovedCopy& one) {
        const auto at = task_for.find(one.original);
        if (at == task_for.end()) {
            plan.moved.push_back(one);
            return;
        }
        BuildTask& task = plan.tasks[at->second];
        task.moved.push_back(one);
        task.moved.back().original = task.index;  // of which it may be a copy
    };
    for (const ObjectIndex index : order) {
        const Object& object = model.objects[index];
        if (!shows(object))
            continue;
        ++plan.objects;
        if (is_always_opened(object))
            continue;
        Hash wanted = build_hash_of(object, of_settings, surroundings.layers[index],
                                    surroundings.ground[index]);
        std::optional<PoseBinding> bind;
        if (deforming[index] != 0) {
            if (!object.deforms || object.group() || poses.empty())
                continue;
            bind = poses.of(object, hash_of(settings));
            if (!bind) {
                plan.not_followed.push_back(index);
                continue;
            }
            wanted = Hasher().value(wanted).value(bind->hash).result();
        }
        plan.wanted[index] = wanted;
        const Hash content = Hasher().value(wanted).value(object.source_hash).result();
        const auto same = task_of.find(content);
        const auto same_moved = moved_one_of.find(content);
        if (same != task_of.end()) {
            plan.tasks[same->second].copies.push_back(index);
            task_for.emplace(index, same->second);
        } else if (same_moved != moved_one_of.end()) {
            MovedCopy one = same_moved->second;
            one.index = index;
            move(one);
        } else if (shelf.adopt(model, index, wanted, palette) || !inside[index]) {
            continue;
        } else if (const auto at = moved.find(index); at != moved.end()) {
            moved_one_of.emplace(content, at->second);
            move(at->second);
        } else {
            task_of.emplace(content, plan.tasks.size());
            task_for.emplace(index, plan.tasks.size());
            plan.tasks.push_back({{index, {}}, std::move(bind), {}});
        }
    }
    return plan;
}

}  // namespace lodestone::hierarchy
