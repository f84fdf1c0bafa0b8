// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface_partition.h"

#include <algorithm>
#include <numeric>

namespace lodestone::geometry {
namespace {

glm::dvec3 corner_sum(const Mesh& mesh, uint32_t triangle) {
    const Triangle& t = mesh.triangles[triangle];
    return glm::dvec3(mesh.positions[t.x]) + glm::dvec3(mesh.positions[t.y]) +
           glm::dvec3(mesh.positions[t.z]);
}

/// Finds the plane that parts some triangles in two halves, and moves those of the first half to
/// the front; returns their number.
size_t part(const Mesh& mesh, std::span<uint32_t> triangles, SurfacePlane& plane) {
    Box3 middles;
    for (const uint32_t t : triangles)
        middles.add(corner_sum(mesh, t));
    if (triangles.empty())
        return 0;
    const glm::dvec3 size = middles.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    const auto at = [&](uint32_t t) { return corner_sum(mesh, t)[axis]; };
    const auto middle = triangles.begin() + static_cast<std::ptrdiff_t>(triangles.size() / 2);
    std::nth_element(triangles.begin(), middle, triangles.end(), [&](uint32_t a, uint32_t b) {
        return std::pair(at(a), a) < std::pair(at(b), b);
    });
    plane = {static_cast<uint32_t>(axis), at(*middle)};
    const auto end = std::partition(triangles.begin(), triangles.end(),
                                    [&](uint32_t t) { return at(t) < plane.sum; });
    return static_cast<size_t>(end - triangles.begin());
}

}  // namespace

SurfaceTree part_surface(const Mesh& mesh, size_t triangles, uint32_t deepest,
                         std::vector<uint16_t>& chunks) {
    SurfaceTree tree;
    while (tree.depth < std::min(deepest, kDeepestSurface) &&
           (mesh.triangles.size() >> tree.depth) > triangles)
        ++tree.depth;
    tree.planes.resize(tree.chunks() - size_t{1});
    tree.boxes.resize(tree.chunks());
    std::vector<uint32_t> order(mesh.triangles.size());
    std::iota(order.begin(), order.end(), 0);
    std::vector<std::span<uint32_t>> regions{order};  // of the planes, then of the chunks
    for (size_t i = 0; i < tree.planes.size(); ++i) {
        const size_t first = part(mesh, regions[i], tree.planes[i]);
        regions.push_back(regions[i].first(first));
        regions.push_back(regions[i].subspan(first));
    }
    chunks.resize(mesh.triangles.size());
    for (uint32_t chunk = 0; chunk < tree.chunks(); ++chunk) {
        for (const uint32_t t : regions[tree.planes.size() + chunk]) {
            chunks[t] = static_cast<uint16_t>(chunk);
            for (int corner = 0; corner < 3; ++corner)
                tree.boxes[chunk].add(glm::dvec3(mesh.positions[mesh.triangles[t][corner]]));
        }
    }
    tree.hash = Hasher()
                    .value(hash_of(mesh))
                    .value(tree.depth)
                    .array(std::span<const uint16_t>(chunks))
                    .result();
    return tree;
}

}  // namespace lodestone::geometry
