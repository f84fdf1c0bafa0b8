// SPDX-License-Identifier: GPL-3.0-or-later
// Sight rays: the rays from an eye through a picture, and the normals where they end.
#pragma once

#include "model/mesh.h"
#include "model/view.h"

namespace lodestone::light {

struct SightRay {
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0, 0, -1};  // has length 1
    double z = 0;                    // metres of the way to its origin
};

/// The ray through a place of the picture (0...1 from its left, top).
SightRay sight_ray(const View& view, double x, double y);

/// The normals of a point, toward the side from which it is seen; both have length 1.
struct SightNormals {
    glm::dvec3 flat{0, 0, 1};    // of the triangle
    glm::dvec3 smooth{0, 0, 1};  // as the mesh's normals say
    bool any = false;            // false: the triangle has no area
};
/// Those of a point of a placed mesh's triangle (barycentric u, v) that a ray meets.
SightNormals sight_normals(const Mesh& mesh, const Affine& world, uint32_t triangle, double u,
                           double v, const glm::dvec3& direction);

/// The direction of a ray that a mirror sends back.
inline glm::dvec3 mirror_direction(const glm::dvec3& direction, const glm::dvec3& normal) {
    return direction - 2 * glm::dot(direction, normal) * normal;
}

}  // namespace lodestone::light
