// SPDX-License-Identifier: GPL-3.0-or-later
// OutsideSides: which sides of a mesh's triangles can be seen from outside at all.
#pragma once

#include "ray/mesh_scene.h"

namespace lodestone::measure {

/// A side of a triangle; the front is the side from which the corners run counterclockwise.
enum class VisibleSide : uint8_t { Both, Front, Back };

/// The sides of a mesh's connected parts that can be seen: of a closed part the one away from its
/// volume, of an open one both. A part that rays pass through is open.
struct OutsideSides {
    std::vector<VisibleSide> of;  // one side a triangle
    uint32_t parts = 0;           // parts connected by corners in one place
    bool may_coincide = true;     // several parts, or not manifold: surfaces may share places
    /// All is in one part that, as far as its edges tell, hides nothing of itself: it is closed,
    /// without handles and convex at every edge; or it is open and flat.
    bool hides_nothing = false;

    /// Whether both sides of the triangle can be seen.
    bool both(size_t triangle) const { return of[triangle] == VisibleSide::Both; }
};

/// Finds the visible sides; `scene` holds the mesh.
OutsideSides sides_of(const Mesh& mesh, const ray::MeshScene& scene);

}  // namespace lodestone::measure
