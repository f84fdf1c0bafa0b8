// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/surface_level.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace lodestone {
namespace {

void require(bool holds, const char* what) {
    if (!holds)
        fail(Status::BadFile, "a level of a surface has ", what);
}

void check(const SurfaceTree& tree) {
    require(tree.depth <= kDeepestSurface, "too many chunks");
    require(tree.planes.size() + 1 == tree.chunks(), "another number of planes than of chunks");
    require(tree.boxes.size() == tree.chunks(), "another number of boxes than of chunks");
    for (const SurfacePlane& plane : tree.planes)
        require(plane.axis < 3, "a plane across no axis");
}

}  // namespace

uint32_t SurfaceTree::chunk_of(const Mesh& mesh, size_t triangle) const {
    const Triangle& t = mesh.triangles[triangle];
    const glm::dvec3 sum = glm::dvec3(mesh.positions[t.x]) + glm::dvec3(mesh.positions[t.y]) +
                           glm::dvec3(mesh.positions[t.z]);
    uint32_t at = 0;
    for (uint32_t level = 0; level < depth; ++level) {
        const SurfacePlane& plane = planes[at];
        at = 2 * at + (sum[static_cast<int>(plane.axis)] < plane.sum ? 1 : 2);
    }
    return at - (chunks() - 1);
}

Hash hash_of(const SurfaceLevel& level) {
    const SurfaceTree& tree = *level.tree;
    Hasher hasher;
    hasher.value(tree.hash).value(tree.depth).value(level.step).value(level.shift);
    for (const SurfacePlane& plane : tree.planes)
        hasher.value(plane.axis).value(plane.sum);
    for (const Box3& box : tree.boxes) {
        for (int axis = 0; axis < 3; ++axis)
            hasher.value(box.low[axis]).value(box.high[axis]);
    }
    return hasher.array(std::span<const uint32_t>(level.before))
        .array(std::span<const double>(level.errors))
        .array(std::span<const BorderPoint>(level.points))
        .array(std::span<const uint16_t>(level.touches))
        .array(std::span<const BorderCorner>(level.corners))
        .result();
}

void check(const SurfaceLevel& level, size_t vertices, size_t triangles) {
    require(level.tree != nullptr, "no chunks");
    check(*level.tree);
    require(level.shift <= level.tree->depth, "nodes above the whole");
    require(level.before.size() == level.nodes() + size_t{1}, "another number of nodes");
    require(level.before.front() == 0 && level.before.back() == triangles &&
                std::is_sorted(level.before.begin(), level.before.end()),
            "triangles in no node");
    require(level.errors.empty() || level.errors.size() == level.nodes(),
            "another number of errors than of nodes");
    for (const double error : level.errors)
        require(error >= 0 && std::isfinite(error), "an error that is none");
    const size_t points = level.points.size();
    uint32_t touch = 0;
    for (const BorderPoint& point : level.points) {
        require(point.touch >= touch && point.touch <= level.touches.size(),
                "border points out of order");
        touch = point.touch;
        if (point.dies == BorderPoint::kLasts)
            continue;
        require(point.heir < points, "a border point with an heir beyond the last");
        // So every way from heir to heir ends.
        require(point.dies > level.step && level.points[point.heir].dies > point.dies,
                "a border point that outlives its heir");
    }
    for (const uint16_t chunk : level.touches)
        require(chunk < level.tree->chunks(), "a border point at no chunk");
    for (size_t i = 0; i < level.corners.size(); ++i) {
        const BorderCorner& corner = level.corners[i];
        require(corner.vertex < vertices && corner.point < points, "a corner beyond the last");
        require(i == 0 || level.corners[i - 1].vertex < corner.vertex, "corners out of order");
    }
}

}  // namespace lodestone
