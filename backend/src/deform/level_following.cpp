// SPDX-License-Identifier: GPL-3.0-or-later
#include "deform/level_following.h"

#include "base/maths.h"

#include <algorithm>
#include <cmath>

namespace lodestone::deform {
namespace {

/// A normal that differs by less than this from those of all its triangles belongs to a flat face.
/// Taste: 1 minus the cosine of 0.8 degrees; a larger one takes bent faces for flat ones.
constexpr double kFlat = 1e-4;

glm::dvec3 unit(const glm::dvec3& v) {
    const double length = glm::length(v);
    return length > 0 && std::isfinite(length) ? v / length : glm::dvec3(0.0);
}

}  // namespace

void check(const BoundLevel& level) {
    check(level.mesh);
    const size_t vertices = level.mesh.positions.size();
    if (level.places.size() != vertices)
        fail(Status::InvalidArgument, level.places.size(), " places for ", vertices, " vertices");
    if (level.normals.size() != level.mesh.normals.size())
        fail(Status::InvalidArgument, level.normals.size(), " bound normals for ",
             level.mesh.normals.size());
    for (const uint32_t place : level.places) {
        if (place >= level.anchors.size())
            fail(Status::InvalidArgument, "place ", place, " of ", level.anchors.size());
    }
    for (const SurfaceAnchor& anchor : level.anchors) {
        if (!finite(anchor.offset) || !std::isfinite(anchor.u) || !std::isfinite(anchor.v))
            fail(Status::InvalidArgument, "an anchor is not finite");
    }
    for (const std::vector<PoseErrorSample>* list :
         {&level.error_samples.of_source, &level.error_samples.of_level}) {
        for (const PoseErrorSample& w : *list) {
            if (w.level >= level.mesh.triangles.size())
                fail(Status::InvalidArgument, "a witness uses triangle ", w.level, " of ",
                     level.mesh.triangles.size());
            if (!std::isfinite(w.source_u + w.source_v + w.level_u + w.level_v + w.area + w.facet +
                               w.longest))
                fail(Status::InvalidArgument, "a witness is not finite");
        }
    }
    if (!(level.look_error >= 0 && std::isfinite(level.look_error)))
        fail(Status::InvalidArgument, "a look's error is not finite");
    for (const std::vector<glm::vec3>* list :
         {&level.mesh.positions, &level.mesh.normals, &level.normals}) {
        if (!all_finite(*list))
            fail(Status::InvalidArgument, "a bound level has numbers that are not finite");
    }
}

PoseSurface::PoseSurface(const PosedSurface& pose)
    : pose_(pose), normals_(pose.points.size(), glm::dvec3(0.0)), areas_(pose.points.size(), 0.0) {
    for (size_t i = 0; i < pose.triangles.size(); ++i) {
        const Triangle& t = pose.triangles[i];
        if (std::max({t.x, t.y, t.z}) >= pose.points.size())
            fail(Status::InvalidArgument, "triangle ", i, " of a pose uses point ",
                 std::max({t.x, t.y, t.z}), " of ", pose.points.size());
        const glm::dvec3 a(pose.points[t.x]);
        const glm::dvec3 area =
            0.5 * glm::cross(glm::dvec3(pose.points[t.y]) - a, glm::dvec3(pose.points[t.z]) - a);
        if (!finite(area))
            continue;
        const double third = glm::length(area) / 3;
        for (int corner = 0; corner < 3; ++corner) {
            normals_[t[corner]] += area;
            areas_[t[corner]] += third;
        }
    }
    rings_ = geometry::VertexRings(pose.triangles, pose.points.size(),
                                   [](uint32_t point) { return point; });
}

PoseError pose_error(const BoundLevel& level, const Mesh& followed, const PoseSurface& surface) {
    const geometry::VertexRings rings(followed.triangles, level.anchors.size(),
                                      [&](uint32_t vertex) { return level.places[vertex]; });
    return pose_error(level.error_samples,
                      {followed, level.places, rings, surface.pose(), surface.rings()});
}

AnchorFrame anchor_frame_of(const PoseSurface& surface, const SurfaceAnchor& anchor) {
    const Triangle& corners = anchor.corners;
    const double u = anchor.u;
    const double v = anchor.v;
    const std::vector<glm::vec3>& points = surface.pose().points;
    const glm::dvec3 a(points[corners.x]);
    const glm::dvec3 b(points[corners.y]);
    const glm::dvec3 c(points[corners.z]);
    const double w = 1 - u - v;
    AnchorFrame footing;
    footing.point = w * a + u * b + v * c;
    footing.size =
        std::sqrt(std::max(0.0, w * surface.area(corners.x) + u * surface.area(corners.y) +
                                    v * surface.area(corners.z)));
    glm::dvec3 normal =
        unit(w * unit(surface.normal(corners.x)) + u * unit(surface.normal(corners.y)) +
             v * unit(surface.normal(corners.z)));
    if (normal == glm::dvec3(0.0))
        normal = unit(glm::cross(b - a, c - a));
    // The tangent lies along the same edge in every pose, so it turns with the surface.
    const glm::dvec3 tangent = unit((b - a) - glm::dot(b - a, normal) * normal);
    footing.axes = glm::dmat3(tangent, glm::cross(normal, tangent), normal);
    return footing;
}

VertexFacing vertex_facing_of(const Mesh& mesh) {
    VertexFacing out{std::vector<glm::dvec3>(mesh.positions.size(), glm::dvec3(0.0)),
                     std::vector<uint8_t>(mesh.positions.size(), 1)};
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        const glm::dvec3 area = area_vector(mesh, i);
        const glm::dvec3 facing = unit(area);
        for (int corner = 0; corner < 3; ++corner) {
            const uint32_t vertex = mesh.triangles[i][corner];
            out.sums[vertex] += area;
            if (!mesh.normals.empty() && facing != glm::dvec3(0.0) &&
                glm::dot(facing, glm::dvec3(mesh.normals[vertex])) < 1 - kFlat)
                out.flat[vertex] = 0;
        }
    }
    return out;
}

std::optional<Mesh> follow(const BoundLevel& level, const PoseSurface& surface) {
    constexpr double kMost = std::numeric_limits<float>::max();
    const std::vector<glm::vec3>& points = surface.pose().points;
    for (const std::vector<PoseErrorSample>* list :
         {&level.error_samples.of_source, &level.error_samples.of_level}) {
        for (const PoseErrorSample& w : *list) {
            if (std::max({w.source.x, w.source.y, w.source.z}) >= points.size())
                return std::nullopt;
        }
    }
    std::vector<glm::dmat3> axes;
    std::vector<glm::vec3> places;
    axes.reserve(level.anchors.size());
    places.reserve(level.anchors.size());
    for (const SurfaceAnchor& anchor : level.anchors) {
        const Triangle& t = anchor.corners;
        if (std::max({t.x, t.y, t.z}) >= points.size())
            return std::nullopt;
        const AnchorFrame footing = anchor_frame_of(surface, anchor);
        const glm::dvec3 place =
            footing.point + footing.axes * (footing.size * glm::dvec3(anchor.offset));
        if (!finite(place) ||
            std::max({std::abs(place.x), std::abs(place.y), std::abs(place.z)}) > kMost)
            return std::nullopt;
        axes.push_back(footing.axes);
        places.emplace_back(place);
    }
    Mesh mesh = level.mesh;
    for (size_t i = 0; i < mesh.positions.size(); ++i)
        mesh.positions[i] = places[level.places[i]];
    if (mesh.normals.empty())
        return mesh;
    const VertexFacing facing = vertex_facing_of(mesh);
    for (size_t i = 0; i < mesh.normals.size(); ++i) {
        glm::dvec3 normal = unit(axes[level.places[i]] * glm::dvec3(level.normals[i]));
        if (normal == glm::dvec3(0.0))
            normal = unit(facing.sums[i]);
        mesh.normals[i] = normal == glm::dvec3(0.0) ? glm::vec3(0, 0, 1) : glm::vec3(normal);
    }
    return mesh;
}

}  // namespace lodestone::deform
