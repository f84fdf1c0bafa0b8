// SPDX-License-Identifier: GPL-3.0-or-later
// LooseSurfaces: the loose part of a mesh that each triangle belongs to.
#pragma once

#include "model/mesh.h"

#include <vector>

namespace lodestone::group {

/// The part of each triangle, one number a triangle, rising from 0 in the order of first triangles:
/// triangles that share a whole edge have the same number. Where more than one surface meets in an
/// edge (boxes that touch) the edge joins each surface with itself alone.
std::vector<uint32_t> loose_parts(const Mesh& mesh);

}  // namespace lodestone::group
