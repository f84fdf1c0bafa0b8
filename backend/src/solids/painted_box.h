// SPDX-License-Identifier: GPL-3.0-or-later
// Painted box: a box of few colors, for things that one color would not make equally bright from
// all sides.
#pragma once

#include "model/material.h"
#include "model/mesh.h"
#include "model/primitive.h"

#include <glm/vec4.hpp>

#include <optional>
#include <span>

namespace lodestone::solids {

/// A painted box as a mesh of 12 triangles with vertex colors.
struct PaintedBox {
    Mesh mesh;
    Material material;
};

/// `shown`: for each vertex of tessellate_box(box) the color that it should have (red, green,
/// blue), and how much light falls on the box there. Near colors are merged, mostly to two to five;
/// the sum of all light stays. None where one color is enough. `material`: that of the box; its
/// color is not used. Throws Error(Internal) for another number of vertices.
std::optional<PaintedBox> painted_box(const Primitive& box, const Material& material,
                                      std::span<const glm::dvec4> shown);

}  // namespace lodestone::solids
