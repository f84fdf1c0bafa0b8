// SPDX-License-Identifier: GPL-3.0-or-later
// PLY: one mesh without materials; coordinates as they are in the file (no turning to Z up).
#pragma once

#include "model/mesh.h"

#include <string>
#include <string_view>

namespace lodestone::format {

/// Ascii and binary of both byte orders. Vertices: x y z, nx ny nz, s t (or u v, texture_u
/// texture_v), red green blue alpha (or diffuse_red ...; integers are sRGB and are decoded, floats
/// are linear) of any number type; faces: vertex_indices or vertex_index, polygons as a fan from
/// their first corner. Everything else is skipped; faces with indices out of range are left out
/// with a problem. Throws Error(BadFile) naming `name`.
Mesh read_ply(std::string_view bytes, const std::string& name, Problems& problems);

/// Binary, little endian: positions, normals, texture coordinates, colors (bytes where that loses
/// nothing, else floats), triangles. Slots are lost.
std::string write_ply(const Mesh& mesh);

}  // namespace lodestone::format
