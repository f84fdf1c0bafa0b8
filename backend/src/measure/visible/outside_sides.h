// SPDX-License-Identifier: GPL-3.0-or-later
// OutsideSides: which sides of a mesh's triangles can be seen from outside at all.
#pragma once

#include "ray/mesh_scene.h"

namespace lodestone::measure {

/// Front is the side from which the corners run counterclockwise.
enum class VisibleSide : uint8_t { Both, Front, Back };

/// The connected parts of a mesh, one by one: of a closed part one side can be seen, the one away
/// from its volume; of an open one both. What rays pass through is open.
struct OutsideSides {
    std::vector<VisibleSide> of;  // one a triangle
    uint32_t parts = 0;           // connected by corners in one place
    bool may_coincide = true;     // of several parts, or not manifold: surfaces may share places
    /// All in one part that, as far as its edges tell, hides nothing of itself: closed, without
    /// handles and convex at every edge; or open and flat.
    bool hides_nothing = false;

    bool both(size_t triangle) const { return of[triangle] == VisibleSide::Both; }
};

OutsideSides sides_of(const Mesh& mesh, const ray::MeshScene& scene);

}  // namespace lodestone::measure
