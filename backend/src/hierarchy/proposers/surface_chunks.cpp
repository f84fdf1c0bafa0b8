// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/proposers/surface_chunks.h"

#include "geometry/surface_partition.h"

#include <algorithm>

namespace lodestone::hierarchy {
namespace {

// The triangles of a chunk.
// Taste: a chunk is then some 32 edges wide, so that at a Pixel Error of 1 its near side is about
// a fifth nearer than its far one. A larger value chooses more coarsely; a smaller one spends more
// of the triangles on borders, and more time on the errors of chunks.
constexpr size_t kTrianglesOfChunk = 2048;
// The fewest triangles of a large surface.
// Taste: 32 chunks; with fewer, most pictures need the same level of all of them.
constexpr size_t kFewestOfSurface = 32 * kTrianglesOfChunk;
// The most cuts of a surface in two.
// Taste: 4,096 chunks, whose boxes are looked at for each picture; a larger value follows surfaces
// of more than 8 million triangles more closely.
constexpr uint32_t kDeepest = 12;

}  // namespace

bool is_large_surface(const Mesh& mesh) {
    return mesh.triangles.size() > kFewestOfSurface &&
           std::all_of(mesh.positions.begin(), mesh.positions.end(),
                       [](const glm::vec3& position) { return finite(position); });
}

simplify::SimplifiedSurface simplify_in_chunks(const Mesh& mesh, std::span<const size_t> targets,
                                               const Job& job) {
    std::vector<uint16_t> chunks;
    auto tree = std::make_shared<const SurfaceTree>(
        geometry::part_surface(mesh, kTrianglesOfChunk, kDeepest, chunks));
    return simplify::simplify_surface(mesh, std::move(tree), chunks, targets, {}, job);
}

}  // namespace lodestone::hierarchy
