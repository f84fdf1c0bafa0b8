// SPDX-License-Identifier: GPL-3.0-or-later
// SurfaceInertia: area, center of mass and second moments of a surface (dissertation 4.2.7, A.1).
#pragma once

#include "base/maths.h"
#include "model/attributes.h"
#include "model/mesh.h"

namespace lodestone::measure {

/// A surface seen as a thin shell of one kilogram a square metre.
struct SurfaceInertia {
    double area = 0;          // m^2
    glm::dvec3 center{0.0};   // center of mass, metres
    glm::dmat3 moments{0.0};  // integral of (x - center)(x - center)^T dA, m^4

    bool empty() const { return !(area > 0); }
    /// The surface inertia tensor about the center (4.20): trace(moments) I - moments, in m^4.
    glm::dmat3 inertia() const;
};

/// The inertia of a mesh by traversal, every triangle as four point masses (A.1.1); hidden surface
/// counts in full. Triangles without area or with non-finite vertices count nothing. With
/// `both_sides_of_open` a mesh that is not closed() counts twice, as it can be seen from both
/// sides.
SurfaceInertia inertia_of_mesh(const Mesh& mesh, bool both_sides_of_open = false);

/// The inertia of both surfaces together (4.28-4.30).
SurfaceInertia combined(const SurfaceInertia& a, const SurfaceInertia& b);

/// The inertia under a rotation, mirroring, uniform scale s and translation: area s^2, moments s^4.
/// Throws Error(InvalidArgument) for any other transform: areas do not follow a non-uniform scale.
SurfaceInertia transformed(const SurfaceInertia& inertia, const Affine& similarity);
/// All attributes under such a transform; axes stay right-handed. A surface that is stretched has
/// to be measured again.
Attributes transformed(const Attributes& attributes, const Affine& similarity);

/// The variances along the principal axes (moments / area, m^2, descending) and the axes.
SymmetricEigen principal_variances(const SurfaceInertia& inertia);

}  // namespace lodestone::measure
