// SPDX-License-Identifier: GPL-3.0-or-later
#include "build/plan.h"

#include <cmath>
#include <map>

namespace lodestone::build {
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
    const Hash hash = Hasher().value(object.source_hash).value(settings).result();
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

Plan plan_of(const Model& model, const std::vector<ObjectIndex>& order,
             const Surroundings& surroundings, const Shelf& shelf, const Settings& settings) {
    const Hash of_settings = hash_of(settings);
    const std::vector<bool> inside = within(settings.scope, model, order);
    const std::vector<uint8_t> deforming = with_deforming(model);
    const Poses poses(settings.poses);
    Plan plan;
    std::map<Hash, size_t> task_of;  // content-equal objects are built once
    for (const ObjectIndex index : order) {
        const Object& object = model.objects[index];
        if (!shows(object))
            continue;
        ++plan.objects;
        if (is_always_opened(object))
            continue;
        Hash wanted = build_hash_of(object, of_settings, surroundings.layers[index],
                                    surroundings.ground[index]);
        std::optional<Bind> bind;
        if (deforming[index] != 0) {
            if (!object.deforms || object.group() || poses.empty())
                continue;
            bind = poses.of(object, of_settings);
            if (!bind) {
                plan.not_followed.push_back(index);
                continue;
            }
            wanted = Hasher().value(wanted).value(bind->hash).result();
        }
        const auto same = task_of.find(wanted);
        if (same != task_of.end()) {
            plan.tasks[same->second].copies.push_back(index);
        } else if (const Object* stored = shelf.find(wanted)) {
            plan.stored.emplace_back(index, stored);
        } else if (inside[index]) {
            task_of.emplace(wanted, plan.tasks.size());
            plan.tasks.push_back({{index, {}}, wanted, std::move(bind)});
        }
    }
    return plan;
}

}  // namespace lodestone::build
