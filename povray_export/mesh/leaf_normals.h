// SPDX-License-Identifier: GPL-3.0-or-later
// Leaf normals: the shading normals of cut leaves, near enough to their faces for POV-Ray.
#pragma once

#include "model/mesh.h"

#include <optional>

namespace lodestone::povray {

/// The unit normal of a triangle's face, on the side of its shading normals, where these are bent by
/// neighboring faces so far that they are to be less_bent(). None where they are near it, were given
/// on purpose, or the triangle has no area. Own frame.
std::optional<glm::vec3> face_of_bent(const Mesh& mesh, size_t triangle);

/// A unit normal on the side of a face (unit), brought to 15 degrees from the face's where it differs
/// by more. POV-Ray turns normals to whoever looks, Cycles by the face: seen flatter than its normals
/// are bent, a leaf would have the light of its other side.
glm::vec3 less_bent(const glm::vec3& normal, const glm::vec3& face);

}  // namespace lodestone::povray
