// SPDX-License-Identifier: GPL-3.0-or-later
#include "ray/placed_scenes.h"

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace lodestone::ray {
namespace {

/// Placements of a cell that is not split.
/// Taste: a larger value saves cells, for more rays into meshes.
constexpr uint32_t kLeaf = 2;
/// Slices of an axis that may part placements.
/// Taste: a larger value finds slightly better trees in more time.
constexpr size_t kSplits = 16;
/// Splits up to this depth are by area; 32 halves more end any tree.
/// Law: walk() has a stack of 64.
constexpr int kDeepest = 30;

/// The end of rays without one: a missed box, which is infinitely far, must lie beyond it.
/// Law: the largest double.
constexpr double kFarthest = std::numeric_limits<double>::max();

/// The distance at which a ray enters a box within [0, far]; infinite where it does not. `far` is
/// finite.
double entry(const Box3& box, const glm::dvec3& origin, const glm::dvec3& inverse, double far) {
    double near = 0;
    for (int i = 0; i < 3; ++i) {
        const double a = (box.low[i] - origin[i]) * inverse[i];
        const double b = (box.high[i] - origin[i]) * inverse[i];
        // A ray in the plane of a face gives NaN, which keeps the box. Both lines are written so
        // that they are instructions, not branches, which nobody could predict.
        const double enters = b < a ? b : a;
        const double leaves = a > b ? a : b;
        near = enters > near ? enters : near;
        far = leaves < far ? leaves : far;
    }
    return near <= far ? near : std::numeric_limits<double>::infinity();
}

}  // namespace

void PlacedScenes::add(std::shared_ptr<const MeshScene> scene, const Bound& bound,
                       const Affine& world, uint32_t name) {
    const double volume = glm::determinant(world.linear);
    if (!scene || bound.empty() || !world.finite() || !(std::abs(volume) > 0))
        return;
    PlacedScene placed;
    placed.inverse.linear = glm::inverse(world.linear);
    placed.inverse.offset = -(placed.inverse.linear * world.offset);
    if (!placed.inverse.finite())
        return;
    placed.box = transformed(bound, world).box;
    // A flat placement has a box that rounding could miss.
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
        split(0, static_cast<uint32_t>(placed_.size()), 0);
}

/// Divides a range where both sides together are hit least: by the surface area heuristic over
/// kSplits slices of each axis.
/// source: Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies" (2007)
uint32_t PlacedScenes::divide(uint32_t first, uint32_t last, const Box3& middles) {
    const auto bin_of = [&](const PlacedScene& placed, int axis) {
        const double size = middles.high[axis] - middles.low[axis];
        const double share = (placed.box.center()[axis] - middles.low[axis]) / size;
        const double at = share * kSplits;
        return at > 0 ? static_cast<size_t>(std::min(at, kSplits - 1.0)) : size_t{0};  // NaN: 0
    };
    const auto area = [](const Box3& box) {
        const glm::dvec3 size = box.size();
        return size.x * size.y + size.y * size.z + size.z * size.x;
    };
    double least = std::numeric_limits<double>::infinity();
    int axis_of_least = 0;
    size_t bin_of_least = 0;
    for (int axis = 0; axis < 3; ++axis) {
        if (!(middles.high[axis] > middles.low[axis]))
            continue;
        std::array<Box3, kSplits> boxes{};
        std::array<size_t, kSplits> counts{};
        for (uint32_t i = first; i < last; ++i) {
            const size_t bin = bin_of(placed_[i], axis);
            boxes[bin].add(placed_[i].box);
            ++counts[bin];
        }
        std::array<double, kSplits> behind{};  // cost of this bin and all behind it
        Box3 box;
        size_t count = 0;
        for (size_t bin = kSplits; bin-- > 1;) {
            box.add(boxes[bin]);
            count += counts[bin];
            behind[bin] = area(box) * static_cast<double>(count);
        }
        box = {};
        count = 0;
        for (size_t bin = 0; bin + 1 < kSplits; ++bin) {
            box.add(boxes[bin]);
            count += counts[bin];
            const double cost = area(box) * static_cast<double>(count) + behind[bin + 1];
            if (count > 0 && count < last - first && cost < least) {
                least = cost;
                axis_of_least = axis;
                bin_of_least = bin;
            }
        }
    }
    if (std::isinf(least))
        return first;
    const auto middle = std::stable_partition(
        placed_.begin() + first, placed_.begin() + last,
        [&](const PlacedScene& placed) { return bin_of(placed, axis_of_least) <= bin_of_least; });
    return static_cast<uint32_t>(middle - placed_.begin());
}

void PlacedScenes::split(uint32_t first, uint32_t last, int depth) {
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
    uint32_t middle = depth < kDeepest ? divide(first, last, middles) : first;
    if (middle == first)  // all in one place, or a tree like a list
        middle = first + (last - first) / 2;
    split(first, middle, depth + 1);
    cells_[here].first = static_cast<uint32_t>(cells_.size());
    split(middle, last, depth + 1);
}

template <typename Visit>
void PlacedScenes::walk(const glm::dvec3& origin, const glm::dvec3& direction, double& far,
                        const Visit& visit) const {
    if (cells_.empty() || !(glm::dot(direction, direction) > 0))
        return;
    const glm::dvec3 inverse = 1.0 / direction;
    struct PendingCell {
        uint32_t cell;
        double near;
    };
    std::array<PendingCell, 64> stack;  // a tree is no deeper than that
    size_t depth = 0;
    const auto open = [&](uint32_t index, double near) {
        if (near <= far)
            stack[depth++] = {index, near};
    };
    open(0, entry(cells_[0].box, origin, inverse, far));
    while (depth > 0) {
        const auto [index, near] = stack[--depth];
        if (!(near <= far))  // something nearer was found since
            continue;
        const SceneCell& cell = cells_[index];
        if (cell.count == 0) {
            // The nearer child comes first: cells that it hides are not looked at.
            const double left = entry(cells_[index + 1].box, origin, inverse, far);
            const double right = entry(cells_[cell.first].box, origin, inverse, far);
            if (right < left) {
                open(index + 1, left);
                open(cell.first, right);
            } else {
                open(cell.first, right);
                open(index + 1, left);
            }
            continue;
        }
        for (uint32_t i = cell.first; i < cell.first + cell.count; ++i) {
            const PlacedScene& placed = placed_[i];
            if (entry(placed.box, origin, inverse, far) <= far && visit(placed))
                return;
        }
    }
}

PlacedScenes::PlacedHit PlacedScenes::first_hit(const glm::dvec3& origin,
                                                const glm::dvec3& direction, double far) const {
    far = std::min(far, kFarthest);
    PlacedHit best;
    walk(origin, direction, far, [&](const PlacedScene& placed) {
        const ray::RayHit hit =
            placed.scene->first_hit(placed.inverse(origin), placed.inverse.linear * direction, far);
        if (hit.hit && (hit.t < best.t || (hit.t == best.t && placed.name < best.name))) {
            best = {true, placed.name, hit.triangle, hit.u, hit.v, hit.t};
            far = hit.t;
        }
        return false;
    });
    return best;
}

void PlacedScenes::visit(const glm::dvec3& origin, const glm::dvec3& direction, double far,
                         const VisitPlaced& visit) const {
    far = std::min(far, kFarthest);
    walk(origin, direction, far, [&](const PlacedScene& placed) {
        far = std::min(far, visit(*placed.scene, placed.name, placed.inverse(origin),
                                  placed.inverse.linear * direction, far));
        return false;
    });
}

bool PlacedScenes::occluded(const glm::dvec3& origin, const glm::dvec3& direction,
                            double far) const {
    uint32_t blocker = kNothing;
    return occluded(origin, direction, far, blocker);
}

bool PlacedScenes::occluded(const glm::dvec3& origin, const glm::dvec3& direction, double far,
                            uint32_t& blocker) const {
    far = std::min(far, kFarthest);
    const auto blocks = [&](const PlacedScene& placed) {
        return placed.scene->occluded(placed.inverse(origin), placed.inverse.linear * direction,
                                      far);
    };
    if (blocker < placed_.size() && glm::dot(direction, direction) > 0) {
        const PlacedScene& last = placed_[blocker];
        if (entry(last.box, origin, 1.0 / direction, far) <= far && blocks(last))
            return true;
    }
    bool blocked = false;
    walk(origin, direction, far, [&](const PlacedScene& placed) {
        blocked = blocks(placed);
        if (blocked)
            blocker = static_cast<uint32_t>(&placed - placed_.data());
        return blocked;
    });
    return blocked;
}

}  // namespace lodestone::ray
