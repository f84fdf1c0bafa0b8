// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/lamp/sky_grounds.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace lodestone::povray {
namespace {

// The things that count as grounds.
// Taste: a larger value finds smaller ones, for a test of each thing that moves.
constexpr size_t kMostGrounds = 64;
// The widths of a thing that a ground below it has at least.
// Taste: a smaller value takes tables for grounds.
constexpr double kWider = 3;

// Grounds that are looked below.
// Taste: a larger value finds floors of more rooms, for a test of each thing.
constexpr size_t kMostFloors = 8;
// The widths of a floor in its height, at least.
// Taste: a smaller value takes blocks for floors.
constexpr double kFlat = 8;

double width_of(const Box3& box) {
    return std::min(box.size().x, box.size().y);
}

}  // namespace

SkyGrounds::SkyGrounds(const SkyThings& all) {
    for (const SkyLeaf& leaf : all.leaves()) {
        const Box3 box = transformed(all.finest_of(leaf).summary.bound, leaf.world).box;
        if (leaf.hides && !box.empty() && std::isfinite(width_of(box)))
            grounds_.push_back(box);
    }
    const auto wider = [](const Box3& a, const Box3& b) { return width_of(a) > width_of(b); };
    const size_t kept = std::min(grounds_.size(), kMostGrounds);
    std::partial_sort(grounds_.begin(), grounds_.begin() + static_cast<std::ptrdiff_t>(kept),
                      grounds_.end(), wider);
    grounds_.resize(kept);
    std::copy_if(grounds_.begin(),
                 grounds_.begin() + static_cast<std::ptrdiff_t>(std::min(kept, kMostFloors)),
                 std::back_inserter(floors_),
                 [](const Box3& ground) { return ground.size().z * kFlat <= width_of(ground); });
    for (const SkyLeaf& leaf : all.leaves()) {
        if (floors_.empty() || !leaf.hides)
            continue;
        const Box3 box = transformed(all.finest_of(leaf).summary.bound, leaf.world).box;
        std::erase_if(floors_, [&](const Box3& floor) {
            return box.center().z < floor.low.z && box.low.x < floor.high.x &&
                   box.high.x > floor.low.x && box.low.y < floor.high.y && box.high.y > floor.low.y;
        });
    }
}

bool SkyGrounds::is_floor(const SkyThing& thing) const {
    const Box3 box = transformed(thing.representation->summary.bound, thing.world).box;
    return std::any_of(floors_.begin(), floors_.end(), [&](const Box3& floor) {
        return floor.low == box.low && floor.high == box.high;
    });
}

light::SkyHorizon SkyGrounds::horizon(const SkyThing& thing) const {
    const glm::dvec3 up = glm::transpose(thing.world.linear) * glm::dvec3(0.0, 0.0, 1.0);
    const double length = glm::length(up);
    const Box3 box = transformed(thing.representation->summary.bound, thing.world).box;
    if (!(length > 0) || !std::isfinite(length) || box.empty())
        return {};
    light::SkyHorizon out;
    int nearest = 0;  // axis to the vertical
    for (int axis = 1; axis < 3; ++axis) {
        if (std::abs(up[axis]) > std::abs(up[nearest]))
            nearest = axis;
    }
    out.up = glm::dvec3(0.0);
    out.up[nearest] = up[nearest] > 0 ? 1 : -1;
    out.upright = true;
    const glm::dvec3 middle = box.center();
    const double wanted = kWider * std::max(box.size().x, box.size().y);
    const bool above = std::any_of(grounds_.begin(), grounds_.end(), [&](const Box3& ground) {
        return width_of(ground) >= wanted && ground.low.z <= middle.z && ground.low.x <= middle.x &&
               middle.x <= ground.high.x && ground.low.y <= middle.y && middle.y <= ground.high.y;
    });
    if (above)
        out.below = 0;
    return out;
}

}  // namespace lodestone::povray
