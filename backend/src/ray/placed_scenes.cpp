// SPDX-License-Identifier: GPL-3.0-or-later
#include "ray/placed_scenes.h"

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace lodestone::ray {
namespace {

constexpr uint32_t kLeaf = 2;  // placements of a cell that is not split

/// Where a ray enters a box within [0, far]; infinite where it does not.
double entry(const Box3& box, const glm::dvec3& origin, const glm::dvec3& inverse, double far) {
    double near = 0;
    for (int i = 0; i < 3; ++i) {
        double a = (box.low[i] - origin[i]) * inverse[i];
        double b = (box.high[i] - origin[i]) * inverse[i];
        if (a > b)
            std::swap(a, b);
        // A ray in the plane of a face gives NaN, which keeps the box.
        if (a > near)
            near = a;
        if (b < far)
            far = b;
    }
    return near <= far ? near : std::numeric_limits<double>::infinity();
}

}  // namespace

void PlacedScenes::add(std::shared_ptr<const Scene> scene, const Bound& bound, const Affine& world,
                       uint32_t name) {
    const double volume = glm::determinant(world.linear);
    if (!scene || bound.empty() || !world.finite() || !(std::abs(volume) > 0))
        return;
    Placed placed;
    placed.inverse.linear = glm::inverse(world.linear);
    placed.inverse.offset = -(placed.inverse.linear * world.offset);
    if (!placed.inverse.finite())
        return;
    placed.box = transformed(bound, world).box;
    // What is flat has a box that rounding could miss.
    const double margin = 1e-6 * (glm::length(placed.box.size()) +
                                  glm::length(glm::abs(placed.box.low) + placed.box.high));
    placed.box.low -= margin;
    placed.box.high += margin;
    placed.scene = std::move(scene);
    placed.name = name;
    all_.add(placed.box);
    placed_.push_back(std::move(placed));
}

void PlacedScenes::finish() {
    cells_.clear();
    if (!placed_.empty())
        split(0, static_cast<uint32_t>(placed_.size()));
}

void PlacedScenes::split(uint32_t first, uint32_t last) {
    const size_t here = cells_.size();
    cells_.emplace_back();
    Box3 box;
    Box3 middles;
    for (uint32_t i = first; i < last; ++i) {
        box.add(placed_[i].box);
        middles.add(placed_[i].box.center());
    }
    cells_[here].box = box;
    if (last - first <= kLeaf) {
        cells_[here].first = first;
        cells_[here].count = last - first;
        return;
    }
    const glm::dvec3 size = middles.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    std::stable_sort(placed_.begin() + first, placed_.begin() + last,
                     [axis](const Placed& a, const Placed& b) {
                         return a.box.center()[axis] < b.box.center()[axis];
                     });
    const uint32_t middle = first + (last - first) / 2;
    split(first, middle);
    cells_[here].first = static_cast<uint32_t>(cells_.size());
    split(middle, last);
}

template <typename Visit>
void PlacedScenes::walk(const glm::dvec3& origin, const glm::dvec3& direction, double& far,
                        const Visit& visit) const {
    if (cells_.empty() || !(glm::dot(direction, direction) > 0))
        return;
    const glm::dvec3 inverse = 1.0 / direction;
    std::array<uint32_t, 64> stack{};  // halves of 2^32 placements are not deeper
    size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const uint32_t index = stack[--depth];
        const Cell& cell = cells_[index];
        if (!(entry(cell.box, origin, inverse, far) <= far))
            continue;
        if (cell.count == 0) {
            stack[depth++] = cell.first;
            stack[depth++] = index + 1;
            continue;
        }
        for (uint32_t i = cell.first; i < cell.first + cell.count; ++i) {
            const Placed& placed = placed_[i];
            if (entry(placed.box, origin, inverse, far) <= far && visit(placed))
                return;
        }
    }
}

PlacedScenes::Hit PlacedScenes::first_hit(const glm::dvec3& origin, const glm::dvec3& direction,
                                          double far) const {
    Hit best;
    walk(origin, direction, far, [&](const Placed& placed) {
        const ray::Hit hit =
            placed.scene->first_hit(placed.inverse(origin), placed.inverse.linear * direction, far);
        if (hit.hit && (hit.t < best.t || (hit.t == best.t && placed.name < best.name))) {
            best = {true, placed.name, hit.triangle, hit.u, hit.v, hit.t};
            far = hit.t;
        }
        return false;
    });
    return best;
}

bool PlacedScenes::occluded(const glm::dvec3& origin, const glm::dvec3& direction,
                            double far) const {
    bool blocked = false;
    walk(origin, direction, far, [&](const Placed& placed) {
        blocked =
            placed.scene->occluded(placed.inverse(origin), placed.inverse.linear * direction, far);
        return blocked;
    });
    return blocked;
}

}  // namespace lodestone::ray
