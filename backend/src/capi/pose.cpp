// SPDX-License-Identifier: GPL-3.0-or-later
#include "capi/pose.h"

#include "base/hash.h"

namespace lodestone::capi {
namespace {

std::vector<glm::vec3> points_of(const float* positions, size_t count) {
    std::vector<glm::vec3> points;
    points.reserve(count);
    for (size_t i = 0; i < count && positions != nullptr; ++i)
        points.emplace_back(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]);
    return points;
}

/// `count` items of `width` floats; null is told from none.
void hash_floats(Hasher& hasher, const float* values, size_t width, size_t count) {
    hasher.value(values != nullptr);
    if (values != nullptr)
        hasher.array(std::span<const float>(values, width * count));
}

}  // namespace

std::shared_ptr<const PosedSurface> pose_of(const lds_mesh_view& view, const lds_object_info& info,
                                            const Mesh& mesh, size_t material_count) {
    if (info.deforms == 0)
        return nullptr;
    auto pose = std::make_shared<PosedSurface>();
    pose->points = points_of(view.positions, view.vertex_count);
    pose->triangles.reserve(view.triangle_count);
    for (size_t t = 0; t < view.triangle_count; ++t)
        pose->triangles.emplace_back(view.triangles[3 * t], view.triangles[3 * t + 1],
                                     view.triangles[3 * t + 2]);
    const size_t corners = view.corners != nullptr ? view.corner_count : view.vertex_count;
    Hasher hasher;
    hasher.value(info.connectivity).value(view.vertex_count).value(corners).value(material_count);
    hasher.value(view.triangle_count).array(std::span<const uint16_t>(mesh.slots));
    if (info.connectivity == 0) {
        hasher.array(std::span<const Triangle>(pose->triangles));
        if (view.corners != nullptr)
            hasher.array(std::span<const uint32_t>(view.corners, 3 * view.triangle_count));
    }
    hasher.value(view.corner_normals != nullptr);
    hash_floats(hasher, view.corner_uvs, 2, corners);
    hash_floats(hasher, view.corner_colors, 4, corners);
    pose->connectivity = hasher.result();
    return pose;
}

std::shared_ptr<const PosedSurface> pose_of(const PolygonMesh& faces, const lds_object_info& info,
                                            const Mesh& mesh, size_t material_count) {
    if (info.deforms == 0)
        return nullptr;
    auto pose = std::make_shared<PosedSurface>();
    pose->points = points_of(faces.positions, faces.vertex_count);
    pose->triangles = triangulated(faces).corners;
    for (Triangle& triangle : pose->triangles)
        triangle = {faces.vertices[triangle.x], faces.vertices[triangle.y],
                    faces.vertices[triangle.z]};
    // Not the triangles: faces are cut into others as they bend.
    Hasher hasher;
    hasher.value(info.connectivity).value(faces.vertex_count).value(material_count);
    hasher.array(faces.vertices).array(faces.starts);
    hasher.array(std::span<const uint16_t>(mesh.slots));
    hash_floats(hasher, faces.uvs, 2, faces.vertices.size());
    hash_floats(hasher, faces.colors, 4, faces.vertices.size());
    hash_floats(hasher, faces.vertex_colors, 4, faces.vertex_count);
    pose->connectivity = hasher.result();
    return pose;
}

std::shared_ptr<const PosedSurface> pose_of(const Mesh& tubes, const lds_object_info& info,
                                            size_t material_count) {
    if (info.deforms == 0)
        return nullptr;
    auto pose = std::make_shared<PosedSurface>();
    pose->points = tubes.positions;
    pose->triangles = tubes.triangles;
    pose->connectivity = Hasher()
                             .value(info.connectivity)
                             .value(tubes.positions.size())
                             .value(material_count)
                             .array(std::span<const Triangle>(tubes.triangles))
                             .array(std::span<const uint16_t>(tubes.slots))
                             .array(std::span<const glm::vec2>(tubes.uvs))
                             .result();
    return pose;
}

}  // namespace lodestone::capi
