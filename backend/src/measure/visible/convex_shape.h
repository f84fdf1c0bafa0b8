// SPDX-License-Identifier: GPL-3.0-or-later
// ShapeConvexity: meshes that hide nothing of themselves, and boxes or ellipsoids just inside or around.
#pragma once

#include "model/representation.h"

#include <optional>

namespace lodestone::measure {

/// A box or ellipsoid scaled about its center, beside a convex mesh.
struct ScaledSolid {
    double scale = 1;
    double gap = 0;  // metres: how far its outline is from the mesh's, seen from anywhere
};

struct ShapeConvexity {
    /// One closed solid that is convex, except at concave edges so flat (diagonals of bent quads)
    /// that next to no light is lost in them. Its triangles face outwards.
    bool convex = false;
    double hollow = 0;  // metres: how deep such edges lie below the convex hull at most
    /// Whether it is flat or convex, its shading normals too: as a mirror it shows nothing larger
    /// than a flat mirror would.
    bool flattens = false;
};

/// cost: 1 to 2 us a triangle.
ShapeConvexity convexity_of(const Mesh& mesh);

/// The largest copy of a box or ellipsoid inside a convex mesh; nothing when its center is not.
std::optional<ScaledSolid> inside(const Mesh& convex, const Primitive& solid, bool box);
/// The smallest around any mesh; nothing when it has no vertices.
std::optional<ScaledSolid> around(const Mesh& mesh, const Primitive& solid, bool box);

}  // namespace lodestone::measure
