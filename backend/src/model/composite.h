// SPDX-License-Identifier: GPL-3.0-or-later
// Composite: several boxes and ellipsoids that are drawn together.
#pragma once

#include "model/primitive.h"

#include <vector>

namespace lodestone {

struct Solid {
    bool box = false;  // else an ellipsoid
    Primitive primitive;
    uint16_t slot = 0;  // of its material
};

/// Shared by value: cheap to copy, never changed once in a representation.
struct Composite {
    std::vector<Solid> solids;
};

Bound bound_of(const Composite& composite);

/// Triangles of all solids, with their slots; an ellipsoid as 20 * 4^subdivisions.
Mesh tessellate(const Composite& composite, int subdivisions = 2);

}  // namespace lodestone
