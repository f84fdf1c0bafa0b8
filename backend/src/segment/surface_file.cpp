// SPDX-License-Identifier: GPL-3.0-or-later
#include "segment/surface_file.h"

#include "segment/array_bytes.h"

namespace lodestone::segment {
namespace {

// The number changes with the layout; a machine of the other byte order reads another one.
// Law: "LdChunk2" in ASCII, little-endian.
constexpr uint64_t kChunkMagic = 0x326b6e756843644cu;
// Law: its axis, and the sum there.
constexpr size_t kPlane = 2;
// Law: the low and the high end along each axis.
constexpr size_t kBox = 6;

}  // namespace

std::string bytes_of(const SurfaceLevel& level) {
    static_assert(sizeof(BorderPoint) == 4 * sizeof(uint32_t) &&
                  sizeof(BorderCorner) == 2 * sizeof(uint32_t));  // no gaps of unknown content
    const SurfaceTree& tree = *level.tree;
    std::vector<double> planes;
    for (const SurfacePlane& plane : tree.planes) {
        planes.push_back(plane.axis);
        planes.push_back(plane.sum);
    }
    std::vector<double> boxes;
    for (const Box3& box : tree.boxes) {
        for (int axis = 0; axis < 3; ++axis)
            boxes.insert(boxes.end(), {box.low[axis], box.high[axis]});
    }
    ArrayWriter writer(kChunkMagic);
    writer.number(tree.hash);
    writer.number(uint64_t{tree.depth});
    writer.number(uint64_t{level.step});
    writer.number(uint64_t{level.shift});
    writer.array(planes);
    writer.array(boxes);
    writer.array(level.before);
    writer.array(level.errors);
    writer.array(level.points);
    writer.array(level.touches);
    writer.array(level.corners);
    return writer.take();
}

SurfaceLevel surface_level_of(const std::string& bytes) {
    ArrayReader reader(bytes, kChunkMagic, "chunks");
    const auto small = [&] {
        const auto value = reader.number<uint64_t>();
        if (value > ~uint32_t{0})
            fail(Status::BadFile, "chunks have a number of ", value);
        return static_cast<uint32_t>(value);
    };
    auto tree = std::make_shared<SurfaceTree>();
    SurfaceLevel level;
    std::vector<double> planes;
    std::vector<double> boxes;
    tree->hash = reader.number<uint64_t>();
    tree->depth = small();
    level.step = small();
    level.shift = small();
    reader.array(planes);
    reader.array(boxes);
    reader.array(level.before);
    reader.array(level.errors);
    reader.array(level.points);
    reader.array(level.touches);
    reader.array(level.corners);
    reader.end();
    for (size_t i = 0; i + kPlane <= planes.size(); i += kPlane) {
        if (!(planes[i] >= 0 && planes[i] < 3))
            fail(Status::BadFile, "chunks have a plane across no axis");
        tree->planes.push_back({static_cast<uint32_t>(planes[i]), planes[i + 1]});
    }
    for (size_t i = 0; i + kBox <= boxes.size(); i += kBox) {
        Box3& box = tree->boxes.emplace_back();
        for (int axis = 0; axis < 3; ++axis) {
            box.low[axis] = boxes[i + 2 * static_cast<size_t>(axis)];
            box.high[axis] = boxes[i + 2 * static_cast<size_t>(axis) + 1];
        }
    }
    level.tree = std::move(tree);
    level.hash = hash_of(level);
    return level;
}

}  // namespace lodestone::segment
