// SPDX-License-Identifier: GPL-3.0-or-later
#include "choose/find_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestone::choose {
namespace {

constexpr uint32_t kNone = ~uint32_t{0};

/// By object, whether it is `object` or holds it.
std::vector<uint8_t> holders(const Model& model, ObjectIndex object) {
    std::vector<uint8_t> holds(model.objects.size(), 0);
    holds.at(object) = 1;
    for (const ObjectIndex index : bottom_up(model)) {
        if (!model.objects[index].group())
            continue;
        for (const Placement& placement :
             model.objects[index].representations[0].assembly().placements) {
            if (holds[placement.object] != 0) {
                holds[index] = 1;
                break;
            }
        }
    }
    return holds;
}

double apart(const Affine& a, const Affine& b) {
    double most = 0;
    for (int axis = 0; axis < 3; ++axis) {
        most = std::max(most, std::abs(a.offset[axis] - b.offset[axis]));
        for (int column = 0; column < 3; ++column)
            most = std::max(most, std::abs(a.linear[column][axis] - b.linear[column][axis]));
    }
    return most;
}

double tolerance(const Affine& world) {
    double size = 1;
    for (int axis = 0; axis < 3; ++axis)
        size = std::max(size, std::abs(world.offset[axis]));
    return 1e-3 * size;
}

struct OccurrenceVisit {
    ObjectIndex object = kNoObject;
    uint32_t parent = kNone;  // the index of a visit
    uint32_t placement = 0;
    Affine world;
};

/// The positions of the placements from the root down to the nearest occurrence; none when there is
/// no occurrence.
std::optional<std::vector<uint32_t>> path_to(const Model& model, ObjectIndex object,
                                             const Affine& world) {
    const std::vector<uint8_t> holds = holders(model, object);
    if (model.root >= holds.size() || holds[model.root] == 0)
        return std::nullopt;
    std::vector<OccurrenceVisit> visits(1);
    visits[0].object = model.root;
    uint32_t best = kNone;
    double nearest = tolerance(world);
    std::vector<uint32_t> stack = {0};
    while (!stack.empty()) {
        const uint32_t at = stack.back();
        stack.pop_back();
        const OccurrenceVisit visit = visits[at];
        if (visit.object == object) {
            const double distance = apart(visit.world, world);
            if (distance < nearest || (best == kNone && distance <= nearest)) {
                nearest = distance;
                best = at;
            }
            continue;
        }
        const std::vector<Placement>& placements =
            model.objects[visit.object].representations[0].assembly().placements;
        for (size_t i = placements.size(); i-- > 0;) {
            if (holds[placements[i].object] == 0)
                continue;
            stack.push_back(static_cast<uint32_t>(visits.size()));
            visits.push_back({placements[i].object, at, static_cast<uint32_t>(i),
                              visit.world * placements[i].transform});
        }
    }
    if (best == kNone)
        return std::nullopt;
    std::vector<uint32_t> path;
    for (uint32_t at = best; visits[at].parent != kNone; at = visits[at].parent)
        path.push_back(visits[at].placement);
    std::reverse(path.begin(), path.end());
    return path;
}

}  // namespace

FoundChoice find_choice(const Model& model, const Cut& cut, ObjectIndex object,
                        const Affine& world) {
    const std::optional<std::vector<uint32_t>> path = path_to(model, object, world);
    if (!path)
        return {};
    if (cut.nodes.empty() || cut.nodes[0].parent != kNoParent)
        return {DrawnState::NotDrawn, kNoParent};
    uint32_t at = 0;
    for (const uint32_t step : *path) {
        if (!cut.nodes[at].opened)
            return {DrawnState::InGroup, at};
        uint32_t below = kNoParent;
        for (uint32_t i = at + 1; i < cut.nodes.size() && below == kNoParent; ++i) {
            if (cut.nodes[i].parent == at && cut.nodes[i].placement == step)
                below = i;
        }
        if (below == kNoParent)
            return {DrawnState::NotDrawn, kNoParent};
        at = below;
    }
    return {cut.nodes[at].opened ? DrawnState::Opened : DrawnState::Itself, at};
}

std::string most_demanding(const Model& model, ObjectIndex group) {
    std::string path;
    const Object* object = &model.objects.at(group);
    while (object->group() && object->demand > 1) {
        const Placement* most = nullptr;
        double demand = 1;
        for (const Placement& placement : object->representations[0].assembly().placements) {
            const double of = placement.coarsest == kAnyLevel
                                  ? placement.importance * model.objects.at(placement.object).demand
                                  : std::numeric_limits<double>::infinity();
            if (of > demand) {
                demand = of;
                most = &placement;
            }
        }
        if (most == nullptr)
            break;
        path += (path.empty() ? "" : "/") + most->name;
        if (most->coarsest != kAnyLevel)
            break;
        object = &model.objects[most->object];
    }
    return path;
}

}  // namespace lodestone::choose
