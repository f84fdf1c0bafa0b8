// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh writer: a mesh as the text of one mesh2.
#pragma once

#include "povray_export/mesh/mesh_textures.h"

#include <string>
#include <string_view>

namespace lodestone::povray {

/// The text `before` and `#declare <identifier> = mesh2{...}`; "" when no triangle has an area.
/// `textures` is null when the occurrence brings its texture. Texture coordinates are written where
/// a texture uses them. Coordinates are rounded by less than a millionth of the mesh's size,
/// normals by 0.00005. Triangles without area after rounding are left out; few triangles, and such
/// with large boxes, have no tree over them. Normals, uvs and positions are shared in whichever way
/// needs the fewest numbers. A mesh whose corners have textures of their own, without bumps, is written
/// in units of its own around its middle, and scaled and moved back.
/// Throws Error(Internal) for a non-finite coordinate.
std::string mesh_text(const Mesh& mesh, const MeshTextures* textures, const std::string& identifier,
                      const Job& job, std::string_view before = {});

}  // namespace lodestone::povray
