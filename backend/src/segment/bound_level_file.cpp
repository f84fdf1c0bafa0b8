// SPDX-License-Identifier: GPL-3.0-or-later
#include "segment/bound_level_file.h"

#include "segment/array_bytes.h"

namespace lodestone::segment {
namespace {

// The number changes with the layout; a machine of the other byte order reads another one.
// Law: "LdBound3" in ASCII, little-endian.
constexpr uint64_t kMagic = 0x33646e756f42644cu;

using deform::BoundLevel;
using deform::PoseErrorSample;
using deform::SurfaceAnchor;

/// Visits every array of a level in the order they lie in the file.
template <typename Level, typename Visit>
void for_each_array(Level& level, const Visit& visit) {
    visit(level.mesh.positions);
    visit(level.mesh.normals);
    visit(level.mesh.uvs);
    visit(level.mesh.colors);
    visit(level.mesh.triangles);
    visit(level.mesh.slots);
    visit(level.places);
    visit(level.anchors);
    visit(level.normals);
    visit(level.error_samples.of_source);
    visit(level.error_samples.of_level);
}

}  // namespace

std::string bytes_of(const BoundLevels& levels) {
    static_assert(sizeof(SurfaceAnchor) == 8 * sizeof(float) &&
                  sizeof(PoseErrorSample) == 11 * sizeof(float));  // no gaps of unknown content
    ArrayWriter writer(kMagic);
    writer.number(uint64_t{levels.size()});
    for (const BoundLevel& level : levels) {
        for_each_array(level, [&](const auto& values) { writer.array(values); });
        writer.number(level.look_error);
    }
    return writer.take();
}

BoundLevels bound_levels_of(const std::string& bytes) {
    ArrayReader reader(bytes, kMagic, "bound levels");
    const auto count = reader.number<uint64_t>();
    BoundLevels levels;
    for (uint64_t i = 0; i < count; ++i) {
        BoundLevel level;
        for_each_array(level, [&](auto& values) { reader.array(values); });
        level.look_error = reader.number<double>();
        try {
            deform::check(level);
        } catch (const Error& error) {
            fail(Status::BadFile, "bound levels cannot be used: ", error.what());
        }
        levels.push_back(std::move(level));
    }
    reader.end();
    return levels;
}

}  // namespace lodestone::segment
