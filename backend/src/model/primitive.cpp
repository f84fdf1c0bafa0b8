// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/primitive.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

namespace lodestone {
namespace {

/// Half extent of the box around an ellipsoid along each world axis.
glm::dvec3 ellipsoid_extent(const Primitive& p) {
    glm::dvec3 extent;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 row(p.axes[0][i] * p.half_size.x, p.axes[1][i] * p.half_size.y,
                             p.axes[2][i] * p.half_size.z);
        extent[i] = glm::length(row);
    }
    return extent;
}

/// The unit ball as triangles.
struct BallTriangles {
    std::vector<glm::dvec3> points;
    std::vector<Triangle> triangles;
};

BallTriangles divided_ball(int subdivisions) {
    // A regular icosahedron, each triangle split in four and pushed out to the sphere.
    const double g = (1 + std::sqrt(5.0)) / 2;
    std::vector<glm::dvec3> points;
    for (const double a : {-1.0, 1.0}) {
        for (const double b : {-g, g}) {
            points.emplace_back(0, a, b);
            points.emplace_back(a, b, 0);
            points.emplace_back(b, 0, a);
        }
    }
    for (glm::dvec3& point : points)
        point = glm::normalize(point);
    std::vector<Triangle> triangles;
    const double edge = 2 / std::sqrt(1 + g * g);
    for (uint32_t i = 0; i < 12; ++i) {
        for (uint32_t j = i + 1; j < 12; ++j) {
            for (uint32_t k = j + 1; k < 12; ++k) {
                if (glm::length(points[i] - points[j]) > edge * 1.01 ||
                    glm::length(points[j] - points[k]) > edge * 1.01 ||
                    glm::length(points[k] - points[i]) > edge * 1.01)
                    continue;
                const bool outward =
                    glm::dot(glm::cross(points[j] - points[i], points[k] - points[i]), points[i]) >
                    0;
                triangles.emplace_back(outward ? Triangle(i, j, k) : Triangle(i, k, j));
            }
        }
    }
    for (int level = 0; level < subdivisions; ++level) {
        std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
        const auto middle = [&](uint32_t a, uint32_t b) {
            const auto [at, fresh] = middles.try_emplace(std::minmax(a, b), 0u);
            if (fresh) {
                at->second = static_cast<uint32_t>(points.size());
                points.push_back(glm::normalize(points[a] + points[b]));
            }
            return at->second;
        };
        std::vector<Triangle> finer;
        finer.reserve(triangles.size() * 4);
        for (const Triangle& t : triangles) {
            const uint32_t ab = middle(t.x, t.y);
            const uint32_t bc = middle(t.y, t.z);
            const uint32_t ca = middle(t.z, t.x);
            finer.emplace_back(t.x, ab, ca);
            finer.emplace_back(ab, t.y, bc);
            finer.emplace_back(ca, bc, t.z);
            finer.emplace_back(ab, bc, ca);
        }
        triangles = std::move(finer);
    }
    return {std::move(points), std::move(triangles)};
}

/// The same, made once for each of the few numbers that are asked for.
const BallTriangles& ball_of(int subdivisions) {
    static std::mutex mutex;
    static std::map<int, BallTriangles> known;
    const std::lock_guard lock(mutex);
    const auto at = known.find(subdivisions);
    return at != known.end()
               ? at->second
               : known.emplace(subdivisions, divided_ball(subdivisions)).first->second;
}

}  // namespace

Affine frame_of(const Primitive& p) {
    return {
        glm::dmat3(p.axes[0] * p.half_size.x, p.axes[1] * p.half_size.y, p.axes[2] * p.half_size.z),
        p.center};
}

Bound bound_of_box(const Primitive& box) {
    Bound unit;
    unit.radius = glm::length(glm::dvec3(1.0));
    unit.box.add(glm::dvec3(-1.0));
    unit.box.add(glm::dvec3(1.0));
    Bound out = transformed(unit, frame_of(box));
    out.radius = glm::length(box.half_size);
    return out;
}

Bound bound_of_ellipsoid(const Primitive& ellipsoid) {
    Bound out;
    const glm::dvec3 extent = ellipsoid_extent(ellipsoid);
    out.center = ellipsoid.center;
    out.radius =
        glm::max(ellipsoid.half_size.x, glm::max(ellipsoid.half_size.y, ellipsoid.half_size.z));
    out.box.add(ellipsoid.center - extent);
    out.box.add(ellipsoid.center + extent);
    return out;
}

Mesh tessellate_box(const Primitive& box) {
    Mesh mesh;
    const Affine frame = frame_of(box);
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3;
        const int v = (axis + 2) % 3;
        for (const double side : {-1.0, 1.0}) {
            const auto first = static_cast<uint32_t>(mesh.positions.size());
            for (int corner = 0; corner < 4; ++corner) {
                glm::dvec3 point;
                point[axis] = side;
                point[u] = (corner == 1 || corner == 2) ? side : -side;
                point[v] = corner >= 2 ? 1.0 : -1.0;
                mesh.positions.emplace_back(frame(point));
                mesh.normals.emplace_back(box.axes[axis] * side);
            }
            mesh.triangles.emplace_back(first, first + 1, first + 2);
            mesh.triangles.emplace_back(first, first + 2, first + 3);
        }
    }
    return mesh;
}

Mesh tessellate_ellipsoid(const Primitive& ellipsoid, int subdivisions) {
    const BallTriangles& ball = ball_of(subdivisions);
    Mesh mesh;
    mesh.triangles = ball.triangles;
    const Affine frame = frame_of(ellipsoid);
    for (const glm::dvec3& point : ball.points) {
        mesh.positions.emplace_back(frame(point));
        const glm::dvec3 normal = ellipsoid.axes * (point / ellipsoid.half_size);
        mesh.normals.emplace_back(glm::normalize(normal));
    }
    return mesh;
}

}  // namespace lodestone
