// SPDX-License-Identifier: GPL-3.0-or-later
// PosedSurface: the surface of something that deforms, in one frame, as its source numbers it.
#pragma once

#include "model/mesh.h"

namespace lodestone {

/// A Mesh splits vertices where normals differ, which may be elsewhere in every frame; the source's
/// vertices stay what they are for as long as `connectivity` does. Object's frame, metres.
struct PosedSurface {
    /// Equal in all frames that differ in nothing but positions and normals (and, with a source of
    /// polygons, in how these are cut into triangles).
    Hash connectivity = 0;
    std::vector<glm::vec3> points;    // by the source's vertex; some may not be finite
    std::vector<Triangle> triangles;  // of these points, each < points.size()
};

}  // namespace lodestone
