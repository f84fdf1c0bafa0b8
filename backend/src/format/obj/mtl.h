// SPDX-License-Identifier: GPL-3.0-or-later
// MTL: the materials beside an OBJ file, with the usual extensions for physically based ones.
#pragma once

#include "base/error.h"
#include "model/material.h"

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lodestone::format {

/// newmtl, Kd (as linear color), Ke, d, Tr, Tf, Ni, illum, Pr, Pm, Pc, Pcr, map_Kd, map_Ke, map_d,
/// map_Pr, map_Pm, norm, bump and map_Bump with -s, -o, -mm, -bm, -clamp, -imfchan; the rest is
/// skipped. A map_Kd replaces Kd. A bump that looks like a normal map is one; else its height is a
/// guess (a problem then). With illum 4, 6 and 7 what d lets through is refracted. Pictures are
/// looked for below `folder` only. What could not be used is a problem of `name`.
std::vector<Material> read_mtl(std::string_view bytes, const std::filesystem::path& folder,
                               const std::string& name, Problems& problems);

struct MaterialLibrary {
    std::string text;
    std::map<std::string, PicturePtr> pictures;  // by the names of their files, beside the MTL
};

/// Names come from mtl_names(). What MTL cannot say of a texture is drawn into a new picture; one
/// that is turned or mirrored counts as its mean, a mixture as its first.
MaterialLibrary write_mtl(std::span<const Material> materials);

/// One a material: unique, printable, without spaces.
std::vector<std::string> mtl_names(std::span<const Material> materials);

}  // namespace lodestone::format
