// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/environment_objects.h"

#include <algorithm>

namespace lodestone::hierarchy {
namespace {

// The height of a ground over its width.
// Taste: a larger value takes hills for grounds, and boxes, too.
constexpr double kMostHeight = 0.1;
// The largest footprint of another thing on a ground, over the ground's.
// Taste: a larger value takes one of several plates for the ground of the others.
constexpr double kMostFootprint = 0.25;
// How far beyond the ground the middle of a thing on it may lie, over the width: walls stand on the
// edge.
// Taste: a larger value takes things that stand beside a plate for things on it.
constexpr double kEdge = 0.05;

const std::vector<Placement>& placements_of(const Object& group) {
    return group.representations[0].assembly().placements;
}

double footprint(const Box3& box) {
    return box.size().x * box.size().y;
}

bool is_above(const Box3& box, const Box3& ground) {
    const glm::dvec3 middle = box.center();
    const glm::dvec3 edge = kEdge * ground.size();
    return middle.z > ground.center().z && middle.x >= ground.low.x - edge.x &&
           middle.x <= ground.high.x + edge.x && middle.y >= ground.low.y - edge.y &&
           middle.y <= ground.high.y + edge.y;
}

}  // namespace

std::vector<uint8_t> marked_environment(const Model& model, const std::vector<ObjectIndex>& order) {
    std::vector<uint8_t> out(model.objects.size(), 0);
    for (const ObjectIndex index : order) {
        const Object& object = model.objects[index];
        out[index] = object.role == ObjectRole::Environment ? 1 : 0;
        if (out[index] != 0 || !object.group())
            continue;
        const std::vector<Placement>& placements = placements_of(object);
        out[index] = !placements.empty() && std::all_of(placements.begin(), placements.end(),
                                                        [&](const Placement& placement) {
                                                            return out[placement.object] != 0;
                                                        })
                         ? 1
                         : 0;
    }
    return out;
}

std::optional<size_t> ground_of(const Model& model, ObjectIndex group,
                                const std::vector<uint8_t>& marked) {
    struct PlacedBox {
        size_t placement;
        Box3 box;
    };
    std::vector<PlacedBox> things;
    const std::vector<Placement>& placements = placements_of(model.objects[group]);
    for (size_t i = 0; i < placements.size(); ++i) {
        const Object& child = model.objects[placements[i].object];
        if (marked[placements[i].object] != 0 || child.representations.empty() ||
            child.bound().empty())
            continue;
        things.push_back({i, transformed(child.bound(), placements[i].transform).box});
    }
    const auto widest = std::max_element(
        things.begin(), things.end(),
        [](const PlacedBox& a, const PlacedBox& b) { return footprint(a.box) < footprint(b.box); });
    if (things.size() < 2 ||
        model.objects[placements[widest->placement].object].role != ObjectRole::Automatic)
        return std::nullopt;
    const glm::dvec3 size = widest->box.size();
    if (!(size.z <= kMostHeight * std::min(size.x, size.y)))
        return std::nullopt;
    size_t above = 0;
    for (const PlacedBox& thing : things) {
        if (thing.placement == widest->placement)
            continue;
        if (!(footprint(thing.box) <= kMostFootprint * footprint(widest->box)))
            return std::nullopt;
        above += is_above(thing.box, widest->box) ? 1 : 0;
    }
    return 2 * above > things.size() - 1 ? std::optional<size_t>(widest->placement) : std::nullopt;
}

std::vector<uint8_t> grounds_of(const Model& model, const std::vector<ObjectIndex>& order,
                                const std::vector<uint8_t>& marked) {
    std::vector<uint8_t> out(model.objects.size(), 0);
    for (auto at = order.rbegin(); at != order.rend(); ++at) {  // parents before children
        const Object& object = model.objects[*at];
        if (!object.group())
            continue;
        const std::vector<Placement>& placements = placements_of(object);
        if (const auto ground = ground_of(model, *at, marked))
            out[placements[*ground].object] = 1;
        for (size_t i = 0; out[*at] != 0 && i < placements.size(); ++i)
            out[placements[i].object] = 1;
    }
    return out;
}

}  // namespace lodestone::hierarchy
