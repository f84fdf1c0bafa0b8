// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes' part of the C interface: what is made of one before it is added.
#include "capi/guard.h"
#include "capi/handles.h"
#include "model/projection.h"

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

/// Throws unless every index of a triangle is in range.
void check_indices(const lds_mesh_view& mesh, const uint32_t* corners, size_t corner_count) {
    for (size_t i = 0; i < 3 * mesh.triangle_count; ++i) {
        if (mesh.triangles[i] >= mesh.vertex_count)
            fail(Status::InvalidArgument, "triangle ", i / 3, " uses vertex ", mesh.triangles[i],
                 " of ", mesh.vertex_count);
        if (corners[i] >= corner_count)
            fail(Status::InvalidArgument, "triangle ", i / 3, " uses corner ", corners[i], " of ",
                 corner_count);
    }
}

}  // namespace

lds_status lds_mesh_project_uvs(const lds_mesh_view* mesh, const lds_uv_projection* projection,
                                float* out_corner_uvs) {
    return guard([&] {
        const lds_mesh_view& view = checked(mesh, "mesh");
        const lds_uv_projection& given = checked(projection, "projection");
        require(out_corner_uvs, "out_corner_uvs");
        if (given.projection < LDS_PROJECTION_FLAT || given.projection > LDS_PROJECTION_TUBE)
            fail(Status::InvalidArgument, "projection ", given.projection, " is unknown");
        const Affine to_space = Affine::from_rows(given.to_space);
        if (!to_space.finite())
            fail(Status::InvalidArgument, "projection.to_space holds numbers that are not finite");
        if (view.triangle_count == 0)
            return;
        require(view.positions, "mesh.positions");
        require(view.triangles, "mesh.triangles");
        const uint32_t* corners = view.corners != nullptr ? view.corners : view.triangles;
        check_indices(view, corners,
                      view.corners != nullptr ? view.corner_count : view.vertex_count);
        const float* points = given.points != nullptr ? given.points : view.positions;
        const int32_t last = static_cast<int32_t>(std::max(given.slot_count, 1u)) - 1;
        for (size_t t = 0; t < view.triangle_count; ++t) {
            const int32_t slot = view.slots != nullptr ? std::clamp(view.slots[t], 0, last) : 0;
            if (given.slot >= 0 && slot != given.slot)
                continue;
            const uint32_t* triangle = view.triangles + 3 * t;
            const glm::dvec3 a = point_at(view.positions, triangle[0]);
            const glm::dvec3 normal = glm::cross(point_at(view.positions, triangle[1]) - a,
                                                 point_at(view.positions, triangle[2]) - a);
            const std::array<glm::dvec2, 3> uvs = project(
                static_cast<Projection>(given.projection),
                {to_space(point_at(points, triangle[0])), to_space(point_at(points, triangle[1])),
                 to_space(point_at(points, triangle[2]))},
                normal);
            for (size_t i = 0; i < 3; ++i) {
                float* to = out_corner_uvs + 2 * size_t{corners[3 * t + i]};
                to[0] = std::isfinite(uvs[i].x) ? static_cast<float>(uvs[i].x) : 0.0f;
                to[1] = std::isfinite(uvs[i].y) ? static_cast<float>(uvs[i].y) : 0.0f;
            }
        }
    });
}
