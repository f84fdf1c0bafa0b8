// SPDX-License-Identifier: GPL-3.0-or-later
// Doubled triangles: those that lie on others, as the other sides of leaves do.
#pragma once

#include "model/mesh.h"

#include <optional>
#include <vector>

namespace lodestone::povray {

/// Takes triangles out of the given ones that lie on another one of them and show the same, and
/// returns them. POV-Ray shows both sides of all, and of two that are cut and rounded by themselves
/// it takes the second for the surface that a ray begins at, and loses all that is behind. Nothing:
/// some that lie on others show something else.
std::optional<std::vector<uint32_t>> take_doubles(const Mesh& mesh,
                                                  std::vector<uint32_t>& triangles);

}  // namespace lodestone::povray
