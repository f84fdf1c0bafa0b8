// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/mesh/leaf_normals.h"

#include <glm/geometric.hpp>

namespace lodestone::povray {
namespace {

/// The cosine of the angle up to which the normals of leaves differ from their faces': 15 degrees.
/// POV-Ray turns normals to whoever looks, so that a leaf which is seen flatter than its normals are
/// bent has the light of its other side, often none.
/// Fitted: on two views of a forest (0, 10, 15, 20, 40 degrees) it is nearest to Cycles, which turns
/// normals by the face; four other tracks with leaves come nearer by less than a hundredth.
constexpr float kBentCosine = 0.9659258F;
/// Law: the sine of that angle.
constexpr float kBentSine = 0.2588190F;
/// The cosine of the angle up to which normals are bent by their neighbors: 60 degrees.
/// Taste: a larger angle also changes normals that were given to a lawn or a crown on purpose, a
/// smaller one leaves sharper folds black.
constexpr float kGivenCosine = 0.5F;

}  // namespace

std::optional<glm::vec3> face_of_bent(const Mesh& mesh, size_t triangle) {
    const Triangle& t = mesh.triangles[triangle];
    const glm::vec3 area(area_vector(mesh, triangle));
    const float size = glm::length(area);
    if (mesh.normals.empty() || !(size > 0))
        return std::nullopt;
    const glm::vec3 sum = mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z];
    const glm::vec3 face = (glm::dot(area, sum) < 0 ? -area : area) / size;
    bool bent = false;
    for (int corner = 0; corner < 3; ++corner) {
        const glm::vec3& normal = mesh.normals[t[corner]];
        const float along = glm::dot(face, normal) / glm::length(normal);
        if (!(along >= kGivenCosine))
            return std::nullopt;
        bent = bent || along < kBentCosine;
    }
    return bent ? std::optional(face) : std::nullopt;
}

glm::vec3 less_bent(const glm::vec3& normal, const glm::vec3& face) {
    const float along = glm::dot(face, normal);
    const glm::vec3 across = normal - along * face;
    const float wide = glm::length(across);
    if (!(along < kBentCosine) || !(wide > 0))
        return normal;
    return kBentCosine * face + kBentSine / wide * across;
}

}  // namespace lodestone::povray
