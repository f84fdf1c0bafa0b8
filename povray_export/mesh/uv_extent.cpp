// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/mesh/uv_extent.h"

#include <cmath>
#include <limits>

namespace lodestone::povray {

double metres_of_uv(const Mesh& mesh, size_t triangle) {
    const Triangle& t = mesh.triangles[triangle];
    const glm::dvec3 a = glm::dvec3(mesh.positions[t.y]) - glm::dvec3(mesh.positions[t.x]);
    const glm::dvec3 b = glm::dvec3(mesh.positions[t.z]) - glm::dvec3(mesh.positions[t.x]);
    const glm::dvec2 ua = glm::dvec2(mesh.uvs[t.y]) - glm::dvec2(mesh.uvs[t.x]);
    const glm::dvec2 ub = glm::dvec2(mesh.uvs[t.z]) - glm::dvec2(mesh.uvs[t.x]);
    const double area = ua.x * ub.y - ua.y * ub.x;
    const glm::dvec3 along_u = (a * ub.y - b * ua.y) / area;
    const glm::dvec3 along_v = (b * ua.x - a * ub.x) / area;
    const double uu = glm::dot(along_u, along_u);
    const double vv = glm::dot(along_v, along_v);
    const double most = (uu + vv) / 2 + std::hypot((uu - vv) / 2, glm::dot(along_u, along_v));
    return most > 0 && std::isfinite(most) ? std::sqrt(most)
                                           : std::numeric_limits<double>::infinity();
}

}  // namespace lodestone::povray
