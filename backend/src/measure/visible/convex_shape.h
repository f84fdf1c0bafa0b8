// SPDX-License-Identifier: GPL-3.0-or-later
// ShapeConvexity: a test whether a mesh hides nothing of itself; boxes and ellipsoids in and around
// it.
#pragma once

#include "model/representation.h"

#include <optional>

namespace lodestone::measure {

/// A box or ellipsoid scaled about its center, beside a convex mesh.
struct ScaledSolid {
    double scale = 1;
    double gap = 0;  // metres: how far its outline is from the mesh's, seen from anywhere
};

/// The convexity of a mesh.
struct ShapeConvexity {
    /// The mesh is one closed solid that is convex, except at concave edges so flat (diagonals of
    /// bent quads) that next to no light is lost in them. Its triangles face outwards.
    bool convex = false;
    double hollow = 0;  // metres: how deep such edges lie below the convex hull at most
    /// The mesh is flat or convex, and so are its shading normals: as a mirror it shows nothing
    /// larger than a flat mirror would.
    bool flattens = false;
};

/// Tests a mesh. cost: 1 to 2 us a triangle.
ShapeConvexity convexity_of(const Mesh& mesh);

/// The largest copy of a box or ellipsoid inside a convex mesh; nothing when the center is not
/// inside.
std::optional<ScaledSolid> inside(const Mesh& convex, const Primitive& solid, bool box);
/// The smallest copy of a box or ellipsoid around any mesh; nothing when the mesh has no vertices.
std::optional<ScaledSolid> around(const Mesh& mesh, const Primitive& solid, bool box);

}  // namespace lodestone::measure
