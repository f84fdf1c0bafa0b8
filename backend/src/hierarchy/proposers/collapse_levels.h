// SPDX-License-Identifier: GPL-3.0-or-later
// Collapse levels: the numbers of triangles that meshes are collapsed to.
#pragma once

#include "hierarchy/build_settings.h"
#include "model/model.h"

#include <vector>

namespace lodestone::hierarchy {

/// A mesh of fewer triangles is not worth it beside primitives.
/// Taste: a larger number leaves coarse levels to solids.
inline constexpr size_t kFewestTriangles = 8;

/// Numbers of triangles that fall by `ratio` from `first` on, as long as a mesh is worth it beside
/// primitives; less than `triangles`.
std::vector<size_t> targets_of(size_t triangles, size_t first, double ratio);
/// The numbers of triangles of a leaf's levels.
std::vector<size_t> targets_of(const Mesh& mesh, const BuildSettings& settings);

/// The materials of a representation by slot; one that is plain where it has none.
std::vector<Material> materials_of(const Model& model, const Representation& finest);

/// The mesh without colors that no material shows: they would only be in the way. `plain` holds the
/// copy.
const Mesh& without_unseen_colors(const Mesh& mesh, const std::vector<Material>& materials,
                                  Mesh& plain);

}  // namespace lodestone::hierarchy
