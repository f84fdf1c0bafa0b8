// SPDX-License-Identifier: GPL-3.0-or-later
// Levels: what is collapsed to how many triangles.
#pragma once

#include "hierarchy/build_settings.h"
#include "model/model.h"

#include <vector>

namespace lodestone::hierarchy {

/// Below these a mesh is not worth it beside primitives.
inline constexpr size_t kFewestTriangles = 8;

/// Falling by `ratio` from `first` on, as long as a mesh is worth it beside primitives; less than
/// `triangles`.
std::vector<size_t> targets_of(size_t triangles, size_t first, double ratio);
/// Triangles of a leaf's levels.
std::vector<size_t> targets_of(const Mesh& mesh, const BuildSettings& settings);

/// By slot; one that is plain where a representation has none.
std::vector<Material> materials_of(const Model& model, const Representation& finest);

/// Without colors that no material shows: they would only be in the way. `plain` holds the copy.
const Mesh& without_unseen_colors(const Mesh& mesh, const std::vector<Material>& materials,
                                  Mesh& plain);

}  // namespace lodestone::hierarchy
