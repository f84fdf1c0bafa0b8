// SPDX-License-Identifier: GPL-3.0-or-later
// MTL: the materials beside an OBJ file.
#pragma once

#include "base/error.h"
#include "model/material.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lodestone::format {

/// newmtl, Kd (as linear color), Ke, Pr, Pm, map_Kd; the rest is skipped. A map_Kd replaces Kd by
/// its mean color; it is looked for below `folder` only. What could not be used is a problem of
/// `name`.
std::vector<Material> read_mtl(std::string_view bytes, const std::filesystem::path& folder,
                               const std::string& name, Problems& problems);

/// Names come from mtl_names().
std::string write_mtl(std::span<const Material> materials);

/// One a material: unique, printable, without spaces.
std::vector<std::string> mtl_names(std::span<const Material> materials);

}  // namespace lodestone::format
