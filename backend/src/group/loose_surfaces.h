// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces: which triangles of a mesh are one loose part.
#pragma once

#include "model/mesh.h"

#include <vector>

namespace lodestone::group {

/// One number a triangle, rising from 0 in order of first triangles: those that share a whole edge
/// have the same. Where more than one surface meets in an edge (boxes that touch) it joins each
/// with itself alone.
std::vector<uint32_t> loose_parts(const Mesh& mesh);

}  // namespace lodestone::group
