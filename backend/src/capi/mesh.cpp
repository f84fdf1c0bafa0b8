// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes' part of the C interface: what is made of one before it is added.
#include "capi/guard.h"
#include "capi/handles.h"
#include "geometry/uv_projection.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

using namespace lodestone;
using namespace lodestone::capi;

namespace {

glm::dvec3 point_at(const float* points, uint32_t index) {
    const float* p = points + 3 * size_t{index};
    return {p[0], p[1], p[2]};
}

/// Writes the coordinates of one slot's corners.
class UvProjector {
public:
    UvProjector(const lds_uv_projection* projection, const float* positions, float* out_corner_uvs)
        : given_(checked(projection, "projection")), positions_(positions), out_(out_corner_uvs) {
        require(out_corner_uvs, "out_corner_uvs");
        if (given_.projection < LDS_PROJECTION_FLAT || given_.projection > LDS_PROJECTION_TUBE)
            fail(Status::InvalidArgument, "projection ", given_.projection, " is unknown");
        to_space_ = Affine::from_rows(given_.to_space);
        if (!to_space_.finite())
            fail(Status::InvalidArgument, "projection.to_space holds numbers that are not finite");
        points_ = given_.points != nullptr ? given_.points : positions;
        last_ = static_cast<int32_t>(std::max(given_.slot_count, 1u)) - 1;
    }

    void write(int32_t slot, const uint32_t vertices[3], const uint32_t corners[3]) const {
        if (given_.slot >= 0 && std::clamp(slot, 0, last_) != given_.slot)
            return;
        const glm::dvec3 a = point_at(positions_, vertices[0]);
        const glm::dvec3 normal = glm::cross(point_at(positions_, vertices[1]) - a,
                                             point_at(positions_, vertices[2]) - a);
        const std::array<glm::dvec2, 3> uvs = project_uvs(
            static_cast<UvProjection>(given_.projection),
            {to_space_(point_at(points_, vertices[0])), to_space_(point_at(points_, vertices[1])),
             to_space_(point_at(points_, vertices[2]))},
            normal);
        for (size_t i = 0; i < 3; ++i) {
            float* to = out_ + 2 * size_t{corners[i]};
            to[0] = std::isfinite(uvs[i].x) ? static_cast<float>(uvs[i].x) : 0.0f;
            to[1] = std::isfinite(uvs[i].y) ? static_cast<float>(uvs[i].y) : 0.0f;
        }
    }

private:
    lds_uv_projection given_;
    const float* positions_;
    const float* points_ = nullptr;
    float* out_;
    Affine to_space_;
    int32_t last_ = 0;
};

template <typename T>
std::span<const T> span_of(const T* values, size_t count) {
    return values == nullptr ? std::span<const T>() : std::span<const T>(values, count);
}

}  // namespace

PolygonMesh lodestone::capi::faces_of(const lds_faces_view* view) {
    const lds_faces_view given = checked(view, "faces");
    if (given.vertex_count > 0)
        require(given.positions, "faces.positions");
    if (given.corner_count > 0)
        require(given.corner_vertices, "faces.corner_vertices");
    if (given.face_starts == nullptr && given.face_count != given.corner_count / 3)
        fail(Status::InvalidArgument, given.face_count, " faces of ", given.corner_count,
             " corners are not triangles");
    PolygonMesh out;
    out.positions = given.positions;
    out.vertex_count = given.vertex_count;
    out.vertices = span_of(given.corner_vertices, given.corner_count);
    out.starts = span_of(given.face_starts, given.face_count);
    out.triangles = span_of(given.triangles, 3 * given.triangle_count);
    out.smooth = span_of(given.face_smooth, given.face_count);
    out.slots = span_of(given.face_slots, given.face_count);
    out.normals = given.corner_normals;
    out.uvs = given.corner_uvs;
    out.colors = given.corner_colors;
    out.vertex_colors = given.vertex_colors;
    check(out);
    return out;
}

lds_status lds_faces_project_uvs(const lds_faces_view* faces, const lds_uv_projection* projection,
                                 float* out_corner_uvs) {
    return guard([&] {
        const PolygonMesh given = faces_of(faces);
        const UvProjector projector(projection, given.positions, out_corner_uvs);
        const FaceTriangles triangles = triangulated(given);
        for (size_t t = 0; t < triangles.corners.size(); ++t) {
            const Triangle& at = triangles.corners[t];
            const uint32_t corners[3] = {at.x, at.y, at.z};
            const uint32_t vertices[3] = {given.vertices[at.x], given.vertices[at.y],
                                          given.vertices[at.z]};
            projector.write(given.slots.empty() ? 0 : given.slots[triangles.faces[t]], vertices,
                            corners);
        }
    });
}

size_t lds_faces_largest(const uint32_t* face_starts, size_t face_count, size_t corner_count) {
    return face_starts == nullptr ? 0 : largest_face({face_starts, face_count}, corner_count);
}
