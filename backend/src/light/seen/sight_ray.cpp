// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/seen/sight_ray.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace lodestone::light {

SightRay sight_ray(const View& view, double x, double y) {
    const Camera& camera = view.camera;
    const glm::dvec3 aside = (x - 0.5) * camera.right + (0.5 - y) * camera.up;
    SightRay ray;
    ray.origin = camera.orthographic ? camera.position + aside : camera.position;
    ray.direction =
        glm::normalize(camera.orthographic ? camera.direction : camera.direction + aside);
    return ray;
}

SightNormals sight_normals(const Mesh& mesh, const Affine& world, uint32_t triangle, double u,
                           double v, const glm::dvec3& direction) {
    SightNormals out;
    const glm::dmat3 turn = glm::transpose(glm::inverse(world.linear));
    out.flat = glm::normalize(turn * area_vector(mesh, triangle));
    out.any = glm::dot(out.flat, out.flat) > 0;
    if (!out.any)
        return out;
    if (glm::dot(out.flat, direction) > 0)
        out.flat = -out.flat;
    out.smooth = out.flat;
    if (mesh.normals.empty())
        return out;
    const Triangle& corners = mesh.triangles[triangle];
    const glm::dvec3 smooth = turn * ((1 - u - v) * glm::dvec3(mesh.normals[corners[0]]) +
                                      u * glm::dvec3(mesh.normals[corners[1]]) +
                                      v * glm::dvec3(mesh.normals[corners[2]]));
    const double length = glm::length(smooth);
    if (length > 0)
        out.smooth = smooth / (glm::dot(smooth, out.flat) < 0 ? -length : length);
    return out;
}

}  // namespace lodestone::light
