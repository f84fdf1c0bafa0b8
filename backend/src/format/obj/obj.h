// SPDX-License-Identifier: GPL-3.0-or-later
// OBJ: meshes with materials; coordinates as they are in the file (usually Y up; no turning).
#pragma once

#include "model/model.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace lodestone::format {

/// v, vt, vn, f (negative indices; polygons as a fan from their first corner), o (an object each),
/// usemtl, mtllib (inside the folder of `path` only); groups, smoothing, curves are skipped. A file
/// of one object gives a model whose root is that object, else a group named after the file.
/// Lines that make no sense are one problem with their number and the first of them.
Model read_obj(std::string_view bytes, const std::filesystem::path& path, Problems& problems);

/// Floats are written so that they read back bit for bit. Materials by slot; `library` is the name
/// of the MTL file ("" = none).
std::string write_obj(const Mesh& mesh, std::span<const Material> materials,
                      const std::string& name, const std::string& library);

}  // namespace lodestone::format
